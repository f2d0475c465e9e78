// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "stillmap/concurrency/prefetcher.hpp"
#include "stillmap/sensor/frame_source.hpp"
#include "stillmap/system/system.hpp"
#include "tooling/pipeline/object_source.hpp"

namespace stillmap {

/// What became of the next frame of a sequence, and the frames that are ready for the system now:
/// others than that, while objects wait for later frames.
struct PreparedFrames {
  SourcedFrame source;                    ///< without its frame; at the end, empty
  std::optional<double> segmentation_ms;  ///< where objects were looked for
  std::vector<PreparedFrame> ready;
  bool at_end = false;  ///< nothing was read: these are the last
};

/// Reads frames, finds their objects and prepares them for the system; with threads, reading runs
/// ahead on one, the rest on another. The results do not depend on that.
class FramePreparation {
 public:
  /// The system outlives this.
  FramePreparation(FrameSource source, ObjectSource objects, const System& system, bool ahead);

  /// The next frame's; once more at the end of the sequence, then nothing. Throws what reading and
  /// segmentation throw.
  [[nodiscard]] std::optional<PreparedFrames> next() { return prepared_.next(); }

 private:
  [[nodiscard]] std::optional<PreparedFrames> prepare();
  [[nodiscard]] std::vector<PreparedFrame> prepare(std::vector<FrameWithObjects> frames) const;

  static constexpr std::size_t kAhead = 4;
  FrameSource source_;
  ObjectSource objects_;
  const System& system_;
  bool ended_ = false;
  Prefetcher<SourcedFrame> read_;
  Prefetcher<PreparedFrames> prepared_;  // last: its thread uses all else
};

}  // namespace stillmap
