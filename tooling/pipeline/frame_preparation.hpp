// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "stillmap/concurrency/prefetcher.hpp"
#include "stillmap/concurrency/stage_probe.hpp"
#include "stillmap/sensor/frame_stream.hpp"
#include "stillmap/system/prepared_frame.hpp"
#include "stillmap/system/system.hpp"
#include "tooling/pipeline/object_source.hpp"

namespace stillmap {

/// Reads frames, finds their objects and prepares them for the system; with threads, reading runs
/// ahead on one, the rest on another. The results do not depend on threads.
class FramePreparation {
 public:
  /// The work on one frame of the stream, and the earlier frames that it has completed: the objects
  /// of a frame are known only some frames later.
  struct Step {
    std::optional<DamagedFrame> damaged;  ///< the frame of the stream, if it is damaged
    std::vector<StageTime> times;         ///< of reading and of the network, if any
    std::vector<PreparedFrame> ready;     ///< for System::process, in order
  };

  /// `stream` and `system` outlive the object. `ahead`: with threads.
  FramePreparation(FrameStream& stream,
                   ObjectSource objects,
                   const System& system,
                   bool ahead,
                   const StageProbe& probe);

  /// One step for each frame and one for the end of the stream, then nothing. Throws what reading
  /// and segmentation throw.
  [[nodiscard]] std::optional<Step> next() { return prepared_.next(); }

 private:
  using TimedFrame = std::pair<StreamedFrame, double>;  // with the reading time, ms
  [[nodiscard]] std::optional<TimedFrame> read();
  [[nodiscard]] std::optional<Step> prepare();
  [[nodiscard]] std::vector<PreparedFrame> prepare(std::vector<FrameObjects> objects);

  static constexpr std::size_t kAhead = 4;
  FrameStream& stream_;
  ObjectSource objects_;
  const System& system_;
  StageProbe probe_;
  std::deque<FramePtr> waiting_;  // for their objects
  bool ended_ = false;
  Prefetcher<TimedFrame> read_;
  Prefetcher<Step> prepared_;  // last: its thread uses all else
};

}  // namespace stillmap
