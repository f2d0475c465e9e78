// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/geometry/se3.hpp"

namespace stillmap {

/// A frame's pose as tracking measured it, by that frame's features alone.
struct MeasuredPose {
  double stamp_s = 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  /// Of a step of T_camera_world by perturb_left(), as far as its features' errors are independent.
  Matrix6d information = Matrix6d::Zero();
  /// Whether the pose has no error, as that of the frame which defines the axes of the world.
  bool is_exact = false;
};

/// The most probable trajectory of a camera that has mass: accelerations, of its place and of its
/// turning, are white noise. Each frame is weighed by its information against the frames before and
/// after it. How noisy the poses are, and how strongly the camera accelerates, is not assumed: both
/// are those under which the given poses are most likely. Poses without noise are thus left nearly
/// as they are; and so are those of a camera that jumps, whose noise would have to be more than ten
/// times that of their information.
///
/// Exact poses stay as they are. Stamps strictly increase. Poses that are too few to tell noise
/// from motion stay as they are. Takes time in proportion to the number of poses.
[[nodiscard]] std::vector<Eigen::Isometry3d> smooth_trajectory(
    std::span<const MeasuredPose> measured);

}  // namespace stillmap
