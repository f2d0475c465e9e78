// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "stillmap/core/ids.hpp"

namespace stillmap {

/// The decisions of the clock for one frame of a live run.
struct LiveStep {
  FrameId frame;
  /// The frames whose objects arrived before it, in order; this frame, too, if it waited for them.
  std::vector<FrameId> objects_of;
  std::string stamp = {};  ///< the frame's stamp as text of its stream; empty where not known

  bool operator==(const LiveStep&) const = default;
};

/// All decisions of the clock in a live run: with them, the run can be repeated bit by bit.
using LiveRecord = std::vector<LiveStep>;

/// The lines of live.jsonl, one for each frame that was processed, in order:
/// `{"stamp":"1341846313.592026","frame":12,"objects_of":[9]}`. Frames have the ids that their
/// stream gave them.
[[nodiscard]] std::string live_jsonl(std::span<const LiveStep> record);

/// Reads such a file; unknown keys are skipped, `stamp` may be missing. Throws Error naming file
/// and line for other text, frames that are not in order, and objects of frames that were not
/// processed before.
[[nodiscard]] LiveRecord read_live_record(const std::filesystem::path& file);

}  // namespace stillmap
