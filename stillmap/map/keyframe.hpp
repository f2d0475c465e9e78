// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/ids.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/features/features.hpp"

namespace stillmap {

/// A frame that the map keeps: its pose, its features and which landmarks they see. No images.
struct Keyframe {
  KeyframeId id;
  FrameId frame;
  Stamp stamp;
  WorldId world{0};
  bool is_origin = false;  ///< the first of its world, which adjustment holds where it is
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  FeaturesPtr features;
  std::vector<LandmarkId> landmarks;  ///< per feature; invalid where it sees none
};

}  // namespace stillmap
