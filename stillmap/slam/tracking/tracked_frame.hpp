// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/ids.hpp"
#include "stillmap/core/status.hpp"
#include "stillmap/geometry/se3.hpp"
#include "stillmap/slam/features/feature_timing.hpp"
#include "stillmap/slam/features/features.hpp"

namespace stillmap {

/// The result of tracking for one frame.
struct TrackedFrame {
  FrameId id;
  double stamp_s = 0;
  TrackingStatus status = TrackingStatus::kLost;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< unless lost
  /// Of a step of the pose's inverse by perturb_left().
  Matrix6d information = Matrix6d::Zero();
  KeyframeId reference;  ///< the key frame that shares most landmarks with the frame
  FeaturesPtr features;
  FeatureTiming timing;               ///< of `features`
  std::vector<LandmarkId> landmarks;  ///< per feature: inliers of the pose; invalid for others
  int inliers = 0;
  std::vector<LandmarkId> expected;  ///< landmarks that should be visible
};

[[nodiscard]] inline bool has_pose(const TrackedFrame& frame) {
  return frame.status != TrackingStatus::kLost;
}

}  // namespace stillmap
