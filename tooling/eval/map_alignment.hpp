// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// T_groundtruth_estimate: where a map lies in truth, by the trajectory of its run.
///
/// In closed form as for the absolute trajectory error, with the same pairs, but the cameras' axes
/// count too, each as a point a metre away on both sides: positions alone leave the rotation open
/// where a camera hardly moves or moves along a line, and at some metres from it the map would be
/// nowhere near. Nothing with fewer than three pairs.
[[nodiscard]] std::optional<Eigen::Isometry3d> map_alignment(const Trajectory& groundtruth,
                                                             const Trajectory& estimate);

}  // namespace stillmap
