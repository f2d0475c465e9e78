// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "stillmap/core/ids.hpp"
#include "stillmap/sensor/tum_sequence.hpp"

namespace stillmap {

/// What the clock has decided for a frame of a live run.
struct LiveStep {
  FrameId frame;
  /// The frames whose objects came in before it, in order; its own when it waited for them.
  std::vector<FrameId> objects_of;

  bool operator==(const LiveStep&) const = default;
};

/// All that the clock has decided in a live run: with it, the run can be made again bit by bit.
using LiveRecord = std::vector<LiveStep>;

/// The lines of live.jsonl, one a frame that was processed, in order:
/// `{"stamp":"1341846313.592026","frame":12,"objects_of":[9]}`. Frames are counted as the
/// sequence's.
[[nodiscard]] std::string live_jsonl(std::span<const LiveStep> record, const TumSequence& sequence);

/// Reads such a file of a run of this sequence; keys that are not known are skipped. Throws Error
/// naming file and line for what is none, frames that the sequence does not have, not in order or
/// of other stamps, and objects of frames that were not processed before.
[[nodiscard]] LiveRecord read_live_record(const std::filesystem::path& file,
                                          const TumSequence& sequence);

}  // namespace stillmap
