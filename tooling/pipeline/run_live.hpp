// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/system/system.hpp"
#include "tooling/pipeline/live_record.hpp"
#include "tooling/pipeline/run_log.hpp"
#include "tooling/pipeline/run_sequence.hpp"

namespace stillmap {

struct LiveInput {
  FrameStream& stream;  ///< every frame that the camera takes
  const SystemConfig& config;
  const RunOptions& options;  ///< with `live`
};

struct LiveResult {
  LiveRecord record;
  LiveReport report;
};

/// Runs the system as with a camera: frames come by the clock, or are those of a record; the
/// network works on some of them on a separate thread, and its objects are carried forward to the
/// other frames until the next result.
[[nodiscard]] LiveResult run_live(const LiveInput& input, System& system, RunLog& log);

}  // namespace stillmap
