// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "tooling/browser/viewed_frame.hpp"
#include "tooling/view/frame_sample.hpp"

namespace stillmap {

/// What a finished run leaves.
struct ViewedEnd {
  PointCloud map;
  Trajectory trajectory;  ///< final poses of frames, by stamp
  Trajectory keyframes;
  std::vector<UnitedTracks> united_tracks = {};
};

/// Values on their way from the run's thread to the viewer's. Putting never waits for the other
/// thread. What does not fit makes room for what is newer: of pictures the newest stays, of
/// frames for the growing map the newest kForMap, of frames' records the newest kFrames.
class ViewInbox {
 public:
  static constexpr std::size_t kForMap = 8;
  static constexpr std::size_t kFrames = 100'000;

  struct Contents {
    std::deque<ViewedFrame> frames;  ///< in order
    std::optional<ViewedSample> newest;
    std::deque<ViewedSample> for_map;  ///< in order
    std::size_t dropped = 0;           ///< frames that the run has dropped, and damaged ones
    std::size_t left_out = 0;          ///< values that made room here
    std::optional<ViewedEnd> end;
  };

  // Each returns whether there was nothing before: the reader has to be woken.
  bool put_frame(ViewedFrame frame, std::optional<ViewedSample> sample);
  bool put_for_map(ViewedSample sample);
  bool put_dropped(std::size_t frames);
  bool put_end(ViewedEnd end);

  /// Everything since the last call.
  [[nodiscard]] Contents take();

 private:
  template <class Change>
  bool put(const Change& change);

  std::mutex mutex_;
  bool waiting_ = false;  // there is something
  Contents contents_;
};

}  // namespace stillmap
