// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Geometry>

namespace stillmap {

/// The velocity of the camera in camera coordinates.
struct CameraVelocity {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< m/s
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< rad/s

  /// The velocity of a static point in camera coordinates.
  [[nodiscard]] Eigen::Vector3d of_point(const Eigen::Vector3d& p_camera) const {
    return -(angular.cross(p_camera) + linear);
  }
};

/// The mean velocity of a motion of `duration_s`; zero if that is not positive.
[[nodiscard]] CameraVelocity mean_velocity(const Eigen::Isometry3d& T_before_after,
                                           double duration_s);

/// The pose of a camera at another time, relative to its pose at time 0.
struct TimedMotion {
  double time_s = 0;
  Eigen::Isometry3d T_now_then = Eigen::Isometry3d::Identity();
};

/// The velocity at time 0 of a camera that moved steadily: the slope of the straight lines that fit
/// the motions best. Zero where all have one time.
[[nodiscard]] CameraVelocity fitted_velocity(std::span<const TimedMotion> motions);

}  // namespace stillmap
