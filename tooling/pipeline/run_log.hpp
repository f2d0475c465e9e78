// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "stillmap/core/stopwatch.hpp"
#include "stillmap/sensor/frame_stream.hpp"
#include "stillmap/session/system_config.hpp"
#include "stillmap/system/system.hpp"
#include "tooling/pipeline/frame_log.hpp"
#include "tooling/pipeline/frame_watch.hpp"
#include "tooling/pipeline/object_log.hpp"
#include "tooling/pipeline/object_watch.hpp"
#include "tooling/pipeline/run_observer.hpp"
#include "tooling/pipeline/run_sequence.hpp"
#include "tooling/pipeline/sample_log.hpp"
#include "tooling/pipeline/timing_log.hpp"

namespace stillmap {

/// Calls the observers that make a run's report and those of the caller; ends the run.
class RunLog {
 public:
  /// All arguments outlive the log. The run's time begins with this call.
  RunLog(const FrameStream& stream,
         const SystemConfig& config,
         const RunOptions& options,
         std::span<Observer* const> observers);
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  /// Reports a damaged frame. Throws Error when too many are damaged.
  void skip(const DamagedFrame& damaged);
  /// All observers, for the system and for events outside of it.
  [[nodiscard]] RunObserver& observers() { return all_; }

  /// Ends the run of a system that calls observers(). To be called once, last.
  [[nodiscard]] SequenceRun finish(System& system);

 private:
  Stopwatch wall_;
  const FrameStream& stream_;
  const RunOptions& options_;
  std::string dynamics_mode_;
  TimingLog timing_;
  FrameLog frames_;
  SampleLog samples_;
  ObjectLog objects_;
  ObjectWatch watch_;
  FrameWatch frame_watch_;
  bool with_objects_;
  ObserverList all_;
};

}  // namespace stillmap
