// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// T_groundtruth_estimate: aligns a map with the ground truth by the trajectory of its run.
///
/// A closed form with the pairs of the absolute trajectory error, in which the axes of the cameras
/// count, too, each as two points one metre away on both sides. Positions alone do not determine
/// the rotation of a camera that hardly moves or moves along a line, and the map would be far off
/// at some metres' distance. Nothing with fewer than three pairs.
[[nodiscard]] std::optional<Eigen::Isometry3d> map_alignment(const Trajectory& groundtruth,
                                                             const Trajectory& estimate);

}  // namespace stillmap
