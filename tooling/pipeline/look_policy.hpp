// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>

#include "stillmap/session/system_config.hpp"
#include "stillmap/system/results.hpp"

namespace stillmap {

/// Decides when the network of a live run looks again, from what the frames between its looks show.
///
/// It looks at once when depth jumps appear, because something has come into view, or when an
/// object that moves has just been seen for the first time, because one look may be wrong. It rests
/// when no object is dynamic and no depth jumps; only in modes that find jumps does that mean that
/// nothing moves. Else the gap is that of the settings.
class LookPolicy {
 public:
  LookPolicy(const LiveConfig& config, bool finds_jumps)
      : config_(config), finds_jumps_(finds_jumps) {}

  /// Takes the result of the next frame.
  void observe(const FrameResult& result);

  /// The least number of frames from the last look to the next.
  [[nodiscard]] int gap_frames() const { return gap_frames_.value_or(config_.look_gap_frames); }

 private:
  LiveConfig config_;
  bool finds_jumps_;
  double jumped_ = 0;              // share of the image, running mean
  std::set<TrackId> known_;        // of dynamic objects
  std::optional<int> gap_frames_;  // nothing before the first frame
};

}  // namespace stillmap
