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

/// Velocity of the camera in its own axes.
struct CameraVelocity {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< m/s
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< rad/s

  /// Velocity that a standing point has as the camera sees it.
  [[nodiscard]] Eigen::Vector3d of_point(const Eigen::Vector3d& p_camera) const;
};

/// The mean velocity over a motion that took `duration_s`; none if that is not positive.
[[nodiscard]] CameraVelocity mean_velocity(const Eigen::Isometry3d& T_before_after,
                                           double duration_s);

/// A rolling shutter reads an image row by row, over `readout_s` from the first to the last, while
/// the camera moves: at 0.4 m/s and 1 m distance that is 5 pixels between the top and the bottom of
/// a Kinect's image. Moves each feature (pixel and depth) to where it was when the middle row was
/// read, which is the instant that poses refer to. Features without depth are turned only.
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
          FieldInfo{"estimate the camera's rolling shutter while tracking"});
    visit("min_readout_s",
          self.min_readout_s,
          FieldInfo{"a shorter readout counts as a global shutter", "s", 0, 0.2});
    visit("max_readout_s",
          self.max_readout_s,
          FieldInfo{"longest readout of an image that is believed", "s", 0, 0.2});
    visit("memory",
          self.memory,
          FieldInfo{"weight of what was learnt before, from frame to frame", "", 0, 0.9999});
  }
};

/// Learns the readout time from how reprojection errors grow from row to row with the camera's
/// velocity: a recursive least-squares estimate of one number, each frame's pose eliminated. A
/// global shutter comes out as 0.
class ReadoutEstimator {
 public:
  ReadoutEstimator(const ShutterConfig& config, const CameraModel& camera);

  /// What to correct with: 0 while the estimate is too short for a real rolling shutter.
  [[nodiscard]] double readout_s() const {
    return estimate_s_ < config_.min_readout_s ? 0.0 : estimate_s_;
  }

  /// `observations` are the inliers of a frame's pose, corrected with readout_s();
  /// `rows` where their features were in the image, in image heights from its middle.
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
