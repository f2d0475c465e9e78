// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "stillmap/slam/features/feature_timing.hpp"
#include "stillmap/slam/optim/pose_optimizer.hpp"

namespace stillmap {

/// How an optimal pose follows the times that its features are corrected for (at_pose_time()), to
/// first order: FeatureTiming::pose_by_times. `row`: row_position() of the feature of each
/// observation; `information`: pose_information() of the same pose and observations.
[[nodiscard]] PoseByTimes pose_by_times(const CameraModel& camera,
                                        const Eigen::Isometry3d& T_camera_world,
                                        std::span<const PoseObservation> observations,
                                        std::span<const double> row,
                                        const CameraVelocity& velocity,
                                        const Matrix6d& information);

/// Brings a pose from the times that were assumed while it was measured to others.
struct TimeCorrection {
  PoseByTimes by_times = PoseByTimes::Zero();
  Vector6d without_times = Vector6d::Zero();

  /// The step by perturb_left().
  [[nodiscard]] Vector6d step(const CameraTimes& times) const;
};

/// The correction of T_frame_reference, the pose of a frame relative to its reference key frame, to
/// first order. The landmarks that the frame was measured against are taken for those of the
/// reference: where both moved alike they are wrong alike, and the relative pose is right.
[[nodiscard]] TimeCorrection time_correction(const FeatureTiming& frame,
                                             const FeatureTiming& reference,
                                             const Eigen::Isometry3d& T_frame_reference);

}  // namespace stillmap
