// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/core/fields.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/tracking/tracked_frame.hpp"

namespace stillmap {

struct KeyframePolicyConfig {
  int min_gap_frames = 6;
  int max_gap_frames = 30;
  double min_tracked_ratio = 0.75;
  int min_near_tracked = 100;
  int min_near_untracked = 70;
  double near_depth_m = 3.0;
  int known_observers = 8;
  double max_known_share = 0.6;
  double min_known_tracked_ratio = 0.5;

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
    visit("known_observers",
          self.known_observers,
          FieldInfo{"a landmark is well known when so many key frames see it", "", 1, 1000});
    visit("max_known_share",
          self.max_known_share,
          FieldInfo{"a place is known where more than this share of a frame's landmarks is: no key "
                    "frame is due there for the longest gap, or for min_tracked_ratio; 1: none is",
                    "",
                    0,
                    1});
    visit("min_known_tracked_ratio",
          self.min_known_tracked_ratio,
          FieldInfo{"but for this share instead of that", "", 0, 1});
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
                                  const KeyframeAge& since_keyframe,
                                  const Map& map);

}  // namespace stillmap
