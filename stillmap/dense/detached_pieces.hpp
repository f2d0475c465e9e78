// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "stillmap/dense/free_space.hpp"

namespace stillmap {

/// The cubes of the map that are left without what hangs in the air: things stand on something or
/// are attached to it.
///
/// Cubes of edge `cell_m` with at most one empty cube between them are one piece. A hand that masks
/// miss again and again is seen too often to be weakly seen, but is a piece by itself: one that
/// extends at most `detached_m` along each axis goes if motion was measured at it more than
/// `max_detached_share` times as often as it was seen. A single cube goes in any case: a surface
/// has neighbours, mixed pixels and remains of noise have none.
///
/// `means` are the means of the points in each cube, `seen` their sightings, `kept` the cubes of
/// the map. All have one size.
[[nodiscard]] std::vector<bool> without_detached_pieces(std::span<const Eigen::Vector3f> means,
                                                        std::span<const Sightings> seen,
                                                        std::vector<bool> kept,
                                                        const FreeSpaceConfig& config);

}  // namespace stillmap
