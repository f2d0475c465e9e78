// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/geometry/camera_velocity.hpp"
#include "stillmap/geometry/se3.hpp"

namespace stillmap {

/// When a camera takes its images.
struct CameraTimes {
  /// Of a rolling shutter: from the first row of a colour image to the last; 0 = global shutter.
  double readout_s = 0;
  /// How much later than its stamp a depth image is taken; negative: earlier. A stamp that is late
  /// itself looks the same.
  double depth_delay_s = 0;
};

/// A quantity of the pose per second of each of the camera's times, (readout_s, depth_delay_s).
using PoseByTimes = Eigen::Matrix<double, 6, 2>;

/// What brings the features of a frame to one time, that of its pose.
struct FeatureTiming {
  CameraVelocity velocity;         ///< that the features are corrected for; zero where unknown
  CameraVelocity smooth_velocity;  ///< by the frames around, later; `velocity` until then
  double depth_stamp_s = 0;        ///< of the depth image, after that of the colour image
  CameraTimes assumed;             ///< the times that the features are corrected for
  /// The step of T_camera_world by perturb_left(), per second, with which the pose found from these
  /// features would follow other times; zero where unknown.
  PoseByTimes pose_by_times = PoseByTimes::Zero();

  [[nodiscard]] double depth_after_color_s() const { return depth_stamp_s + assumed.depth_delay_s; }
};

/// The position of a raw pixel's row, in image heights from the middle row: -1/2 to 1/2.
[[nodiscard]] inline double row_position(const Eigen::Vector2f& raw_px, const CameraModel& camera) {
  return static_cast<double>(raw_px.y()) / camera.height_px - 0.5;
}

}  // namespace stillmap
