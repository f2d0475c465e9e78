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
          common_setting(FieldInfo{
              "least number of frames from one key frame to the next", "frames", 1, 1000}));
    visit("max_gap_frames",
          self.max_gap_frames,
          common_setting(FieldInfo{
              "greatest number of frames from one key frame to the next, outside known places",
              "frames",
              1,
              100000}));
    visit("min_tracked_ratio",
          self.min_tracked_ratio,
          FieldInfo{"share of the most landmarks tracked since the last key frame below which a "
                    "key frame is due",
                    "",
                    0,
                    1});
    visit(
        "min_near_tracked",
        self.min_near_tracked,
        FieldInfo{
            "number of near landmarks below which a key frame is due if min_near_untracked is met",
            "",
            0,
            10000});
    visit("min_near_untracked",
          self.min_near_untracked,
          FieldInfo{
              "number of near features without landmark that make a lack of near landmarks count",
              "",
              0,
              10000});
    visit("near_depth_m",
          self.near_depth_m,
          FieldInfo{"greatest depth of a near landmark or feature", "m", 0.1, 100});
    visit("known_observers",
          self.known_observers,
          FieldInfo{"number of observations that make a landmark well known", "", 1, 1000});
    visit("max_known_share",
          self.max_known_share,
          FieldInfo{"share of well known landmarks above which a place is known and "
                    "min_known_tracked_ratio applies",
                    "",
                    0,
                    1});
    visit("min_known_tracked_ratio",
          self.min_known_tracked_ratio,
          FieldInfo{
              "min_tracked_ratio at known places, where max_gap_frames does not apply", "", 0, 1});
  }
};

/// The frames since the last key frame.
struct KeyframeAge {
  int frames = 0;        ///< number of processed frames
  int most_inliers = 0;  ///< greatest number of inliers in any of them
};

/// Whether a frame becomes a key frame. Depends on frame numbers and counts alone, never on time.
[[nodiscard]] bool wants_keyframe(const KeyframePolicyConfig& config,
                                  const TrackedFrame& frame,
                                  const KeyframeAge& since_keyframe,
                                  const Map& map);

}  // namespace stillmap
