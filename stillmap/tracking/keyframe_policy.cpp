// SPDX-License-Identifier: Apache-2.0
#include "stillmap/tracking/keyframe_policy.hpp"

namespace stillmap {
bool wants_keyframe(const KeyframePolicyConfig& config,
                    const TrackedFrame& frame,
                    const KeyframeAge& since_keyframe) {
  if (!has_pose(frame) || since_keyframe.frames < config.min_gap_frames) return false;
  // What moves in it was judged without knowing where the camera is.
  if (frame.status == TrackingStatus::kRelocalized) return false;
  if (since_keyframe.frames >= config.max_gap_frames) return true;
  if (frame.inliers < config.min_tracked_ratio * since_keyframe.most_inliers) return true;

  int near_tracked = 0, near_untracked = 0;
  for (std::size_t i = 0; i < frame.landmarks.size(); ++i) {
    const float depth = frame.features->depth_m[i];
    if (depth <= 0 || static_cast<double>(depth) > config.near_depth_m) continue;
    ++(frame.landmarks[i].valid() ? near_tracked : near_untracked);
  }
  return near_tracked < config.min_near_tracked && near_untracked >= config.min_near_untracked;
}

}  // namespace stillmap
