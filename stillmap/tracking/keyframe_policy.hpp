// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/core/fields.hpp"
#include "stillmap/tracking/tracked_frame.hpp"

namespace stillmap {

struct KeyframePolicyConfig {
  int min_gap_frames = 4;
  int max_gap_frames = 30;
  double min_tracked_ratio = 0.75;
  int min_near_tracked = 100;
  int min_near_untracked = 70;
  double near_depth_m = 3.0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_gap_frames",
          self.min_gap_frames,
          FieldInfo{"frames from a key frame to the next, at least", "frames", 1, 1000});
    visit("max_gap_frames", self.max_gap_frames, FieldInfo{"at most", "frames", 1, 100000});
    visit(
        "min_tracked_ratio",
        self.min_tracked_ratio,
        FieldInfo{
            "a frame that finds fewer landmarks than this share of the most since the last becomes "
            "one",
            "",
            0,
            1});
    visit("min_near_tracked",
          self.min_near_tracked,
          FieldInfo{"so does one with fewer near landmarks", "", 0, 10000});
    visit("min_near_untracked",
          self.min_near_untracked,
          FieldInfo{"and as many near features that could become landmarks", "", 0, 10000});
    visit("near_depth_m", self.near_depth_m, FieldInfo{"what counts as near", "m", 0.1, 100});
  }
};

/// What has happened since the last key frame.
struct KeyframeAge {
  int frames = 0;        ///< processed since then
  int most_inliers = 0;  ///< in any of them
};

/// Does this frame become a key frame? Decided from frame numbers and counts alone, never from how
/// busy the machine is.
[[nodiscard]] bool wants_keyframe(const KeyframePolicyConfig& config,
                                  const TrackedFrame& frame,
                                  const KeyframeAge& since_keyframe);

}  // namespace stillmap
