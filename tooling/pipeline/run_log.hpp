// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "stillmap/core/stopwatch.hpp"
#include "stillmap/sensor/frame_stream.hpp"
#include "stillmap/system/system.hpp"
#include "tooling/pipeline/object_log.hpp"
#include "tooling/pipeline/run_sequence.hpp"

namespace stillmap {

/// Keeps what a run has to tell, frame by frame, and ends it.
class RunLog {
 public:
  /// What is referred to outlives the log; the run's time begins now.
  RunLog(const FrameStream& stream, const SystemConfig& config, const RunOptions& options);

  void add(const RgbdFrame& frame, const FrameResult& result);
  void add_stage_time(std::string_view stage, double ms);
  /// A damaged frame. Throws Error when there are too many.
  void skip(const DamagedFrame& damaged);
  /// So many frames are done with, without more to tell of them.
  void pass(std::size_t frames);

  /// Ends the run. Once, as the last call.
  [[nodiscard]] SequenceRun finish(System& system);

 private:
  void warn(const std::string& warning);

  Stopwatch wall_;
  const FrameStream& stream_;
  const RunOptions& options_;
  bool with_objects_ = false;
  SequenceRun run_;
  std::vector<LoggedFrame> objects_;
  std::size_t done_ = 0;
};

}  // namespace stillmap
