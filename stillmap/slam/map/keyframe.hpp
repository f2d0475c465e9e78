// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/ids.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/slam/features/feature_timing.hpp"
#include "stillmap/slam/features/features.hpp"

namespace stillmap {

/// A frame kept in the map: its pose, its features and the landmarks that they observe. Has no
/// images.
struct Keyframe {
  KeyframeId id;
  FrameId frame;
  Stamp stamp;
  SubmapId submap{0};
  bool is_origin = false;  ///< the first of its submap; adjustment keeps its pose
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  FeatureTiming timing;  ///< of `features`; zero in a loaded map
  FeaturesPtr features;
  std::vector<LandmarkId> landmarks;  ///< per feature; invalid where it observes none
};

/// The features that observe a landmark, in order.
[[nodiscard]] inline std::vector<std::uint32_t> features_with_landmark(const Keyframe& keyframe) {
  std::vector<std::uint32_t> features;
  for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i) {
    if (keyframe.landmarks[i].valid()) features.push_back(i);
  }
  return features;
}

}  // namespace stillmap
