// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Geometry>

#include "stillmap/core/fields.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/features/features.hpp"
#include "stillmap/slam/optim/pose_optimizer.hpp"

namespace stillmap {

/// The velocity of the camera in camera coordinates.
struct CameraVelocity {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< m/s
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< rad/s

  /// The velocity of a static point in camera coordinates.
  [[nodiscard]] Eigen::Vector3d of_point(const Eigen::Vector3d& p_camera) const;
};

/// The mean velocity of a motion of `duration_s`; zero if that is not positive.
[[nodiscard]] CameraVelocity mean_velocity(const Eigen::Isometry3d& T_before_after,
                                           double duration_s);

/// Moves each feature (pixel and depth) to its position at the readout of the middle row, the time
/// to which poses refer. A rolling shutter reads an image row by row, in `readout_s` from the first
/// to the last, while the camera moves: at 0.4 m/s and 1 m distance this shifts the top against the
/// bottom of a Kinect's image by 5 pixels. Features without depth are only rotated.
[[nodiscard]] Features undo_rolling_shutter(Features features,
                                            const CameraModel& camera,
                                            double readout_s,
                                            const CameraVelocity& velocity);

struct ShutterConfig {
  bool calibrate = true;
  double min_readout_s = 0.01;
  double max_readout_s = 0.04;
  double memory = 0.98;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("calibrate",
          self.calibrate,
          common_setting(FieldInfo{"whether the readout time of the camera's rolling shutter is "
                                   "estimated while tracking"}));
    visit("min_readout_s",
          self.min_readout_s,
          FieldInfo{"shortest readout time of a rolling shutter; a shorter estimate counts as a "
                    "global shutter",
                    "s",
                    0,
                    0.2});
    visit("max_readout_s",
          self.max_readout_s,
          FieldInfo{"longest readout time that the estimate may reach", "s", 0, 0.2});
    visit("memory",
          self.memory,
          FieldInfo{"weight of the earlier frames in the estimate, per frame", "", 0, 0.9999});
  }
};

/// Estimates the readout time from the growth of reprojection errors with the row and the camera's
/// velocity: a recursive least-squares estimate of one number, with the pose of each frame
/// eliminated. For a global shutter it is 0.
class ReadoutEstimator {
 public:
  ReadoutEstimator(const ShutterConfig& config, const CameraModel& camera);

  /// The readout time for correction; 0 while the estimate is too short for a rolling shutter.
  [[nodiscard]] double readout_s() const {
    return estimate_s_ < config_.min_readout_s ? 0.0 : estimate_s_;
  }

  /// `observations` are the inliers of a frame's pose, corrected with readout_s(). `rows` are the
  /// positions of their features in image heights from the middle row.
  void update(const Eigen::Isometry3d& T_camera_world,
              const CameraVelocity& velocity,
              std::span<const PoseObservation> observations,
              std::span<const double> rows);

 private:
  ShutterConfig config_;
  CameraModel camera_;
  double estimate_s_;
  double information_;
};

}  // namespace stillmap
