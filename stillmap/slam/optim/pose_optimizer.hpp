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
  double trust = 1;  ///< its weight, in (0, 1]; the bound for inliers does not depend on it
};

struct PoseEstimate {
  Eigen::Isometry3d T_camera_world;
  std::vector<std::uint8_t> inlier;  ///< per observation
  int inliers = 0;
};

/// Estimates the camera's pose from fixed points: minimises the Huber loss of the reprojection
/// errors (pixels and inverse depth), times the trust in each, by Levenberg-Marquardt in four
/// rounds. After each round the observations beyond the 95 % bound are set aside and the others
/// readmitted; the last rounds are plain least squares over the inliers. Observations of points
/// behind the camera are outliers. With fewer than three points in front of the camera the pose is
/// returned unchanged, without inliers.
[[nodiscard]] PoseEstimate optimize_pose(const CameraModel& camera,
                                         const Eigen::Isometry3d& T_camera_world,
                                         std::span<const PoseObservation> observations);

/// The information that the observations give of a step of the pose by perturb_left(): the inverse
/// of the covariance that they leave. Those behind the camera give none.
[[nodiscard]] Matrix6d pose_information(const CameraModel& camera,
                                        const Eigen::Isometry3d& T_camera_world,
                                        std::span<const PoseObservation> observations);

}  // namespace stillmap
