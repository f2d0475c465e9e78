// SPDX-License-Identifier: Apache-2.0
#include "stillmap/tracking/keyframe_policy.hpp"

namespace stillmap {
namespace {

// Landmarks of the reference key frame that at least three (or, in a young map, two) key frames
// see.
int established_landmarks(const Keyframe& reference, const Map& map) {
  const std::size_t min_observations = map.keyframes().size() > 2 ? 3 : 2;
  int count = 0;
  for (const LandmarkId id : reference.landmarks) {
    const Landmark* landmark = map.find(id);
    if (landmark != nullptr && landmark->observations.size() >= min_observations) ++count;
  }
  return count;
}

}  // namespace

bool wants_keyframe(const KeyframePolicyConfig& config,
                    const TrackedFrame& frame,
                    int frames_since_keyframe,
                    const Map& map) {
  if (!has_pose(frame) || frames_since_keyframe < config.min_gap_frames) return false;
  if (frames_since_keyframe >= config.max_gap_frames) return true;

  int near_tracked = 0, near_untracked = 0;
  for (std::size_t i = 0; i < frame.landmarks.size(); ++i) {
    const float depth = frame.features->depth_m[i];
    if (depth <= 0 || static_cast<double>(depth) > config.near_depth_m) continue;
    ++(frame.landmarks[i].valid() ? near_tracked : near_untracked);
  }
  if (near_tracked < config.min_near_tracked && near_untracked >= config.min_near_untracked) {
    return true;
  }
  const Keyframe& reference = map.keyframe(map.anchor(frame.reference).keyframe);
  return frame.inliers < config.min_tracked_ratio * established_landmarks(reference, map);
}

}  // namespace stillmap
