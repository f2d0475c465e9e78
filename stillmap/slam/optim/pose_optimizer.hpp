// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stillmap/slam/optim/reprojection.hpp"

namespace stillmap {

struct PoseObservation {
  Eigen::Vector3d p_world;
  PointMeasurement measurement;
};

struct PoseEstimate {
  Eigen::Isometry3d T_camera_world;
  std::vector<std::uint8_t> inlier;  ///< per observation
  int inliers = 0;
};

/// The camera's pose against fixed points: minimises Huber's loss of the reprojection errors
/// (pixels and inverse depth) by Levenberg-Marquardt, in four rounds; after each the observations
/// beyond the 95 % bound are set aside and the others readmitted, and the last rounds are plain
/// least squares over the inliers. Observations behind the camera are outliers. With fewer than
/// three observations before the camera the pose is returned as given, with no inliers.
[[nodiscard]] PoseEstimate optimize_pose(const CameraModel& camera,
                                         const Eigen::Isometry3d& T_camera_world,
                                         std::span<const PoseObservation> observations);

}  // namespace stillmap
