// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "stillmap/slam/map/keyframe.hpp"
#include "stillmap/slam/map/landmark.hpp"

namespace stillmap {

/// The pose of a dropped key frame, relative to a key frame that stays.
struct Anchor {
  KeyframeId keyframe;
  Eigen::Isometry3d T_anchor_dropped = Eigen::Isometry3d::Identity();
};

/// The changes in a window of the map: the only way in which a worker's result reaches the owner.
struct MapUpdate {
  std::vector<Keyframe> keyframes;  ///< with a new pose or other landmarks, by id
  std::vector<std::pair<KeyframeId, Anchor>> dropped_keyframes;
  std::vector<Landmark> landmarks;  ///< new or changed, by id; the counts of tracking are ignored
  std::vector<LandmarkId> removed_landmarks;                        ///< by id
  std::vector<std::pair<LandmarkId, LandmarkId>> merged_landmarks;  ///< (gone, into), in order
  LandmarkId next_landmark;
};

}  // namespace stillmap
