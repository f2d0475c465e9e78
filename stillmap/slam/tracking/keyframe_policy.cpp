// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/tracking/keyframe_policy.hpp"

namespace stillmap {
namespace {

/// The share of well known landmarks among those that the frame matched.
double known_share(const TrackedFrame& frame, const Map& map, int observers) {
  int found = 0, known = 0;
  for (const LandmarkId id : frame.landmarks) {
    const Landmark* landmark = map.find(id);
    if (landmark == nullptr) continue;
    ++found;
    known += std::ssize(landmark->observations) >= observers ? 1 : 0;
  }
  return found == 0 ? 0 : static_cast<double>(known) / found;
}

}  // namespace

bool wants_keyframe(const KeyframePolicyConfig& config,
                    const TrackedFrame& frame,
                    const KeyframeAge& since_keyframe,
                    const Map& map) {
  if (!has_pose(frame) || since_keyframe.frames < config.min_gap_frames) return false;
  // The motion in a relocalised frame was judged without a predicted pose.
  if (frame.status == TrackingStatus::kRelocalized) return false;
  const auto finds_fewer = [&](double ratio) {
    return frame.inliers < ratio * since_keyframe.most_inliers;
  };
  if (finds_fewer(config.min_known_tracked_ratio)) return true;
  if (since_keyframe.frames >= config.max_gap_frames || finds_fewer(config.min_tracked_ratio)) {
    if (known_share(frame, map, config.known_observers) <= config.max_known_share) return true;
  }

  int near_tracked = 0, near_untracked = 0;
  for (std::size_t i = 0; i < frame.landmarks.size(); ++i) {
    const float depth = frame.features->depth_m[i];
    if (depth <= 0 || static_cast<double>(depth) > config.near_depth_m) continue;
    ++(frame.landmarks[i].valid() ? near_tracked : near_untracked);
  }
  return near_tracked < config.min_near_tracked && near_untracked >= config.min_near_untracked;
}

}  // namespace stillmap
