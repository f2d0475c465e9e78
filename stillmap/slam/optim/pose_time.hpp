// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/features/feature_timing.hpp"
#include "stillmap/slam/features/features.hpp"

namespace stillmap {

/// Moves each feature (pixel and depth) to its position at the readout of the middle row, the time
/// to which poses refer.
///
/// A rolling shutter reads an image row by row while the camera moves: at 0.4 m/s and 1 m distance,
/// 25 ms from the first row to the last shift the top against the bottom of a Kinect's image by 5
/// pixels. A depth image that is taken later than the colour image has the depths of another time.
/// Features without depth are only rotated.
[[nodiscard]] Features at_pose_time(Features features,
                                    const CameraModel& camera,
                                    const FeatureTiming& timing);

/// The velocity that at_pose_time() corrects a feature for.
[[nodiscard]] inline CameraVelocity corrected_velocity(CameraVelocity velocity, bool has_depth) {
  if (!has_depth) velocity.linear.setZero();
  return velocity;
}

/// The derivative of a feature's residual by the camera's times, (readout_s, depth_delay_s), for
/// the motion of its residual per second, of which the third is zero without depth. A correction
/// moves the measurement against the motion of the point.
[[nodiscard]] inline Eigen::Matrix<double, 3, 2> residual_by_times(const Eigen::Vector3d& motion,
                                                                   double row) {
  Eigen::Matrix<double, 3, 2> result = Eigen::Matrix<double, 3, 2>::Zero();
  result.col(0) = row * motion;
  result(2, 1) = motion.z();
  return result;
}

}  // namespace stillmap
