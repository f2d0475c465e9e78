// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/run_sequence.hpp"

#include <utility>

#include "tooling/pipeline/frame_preparation.hpp"
#include "tooling/pipeline/run_live.hpp"
#include "tooling/pipeline/run_log.hpp"

namespace stillmap {
namespace {

// As fast as possible, without dropping frames.
void run_through(System& system, RunLog& log, FramePreparation& prepared) {
  while (std::optional<FramePreparation::Step> step = prepared.next()) {
    for (const StageTime& time : step->times) log.observers().on_stage_time(time.stage, time.ms);
    if (step->damaged) log.skip(*step->damaged);
    for (PreparedFrame& ready : step->ready) system.process(std::move(ready));
  }
}

}  // namespace

SequenceRun run_sequence(FrameStream& stream,
                         const SystemConfig& config,
                         RunOptions options,
                         std::span<Observer* const> observers) {
  RunLog log(stream, config, options, observers);
  System system(config,
                stream.camera(),
                {.threads = options.threads,
                 .localize_only = options.localize_only,
                 .snapshot_every_frames = options.snapshot_every_frames,
                 .observers = {&log.observers()},
                 .probe = options.probe});
  if (options.start) system.load(std::move(*options.start));
  if (options.live) {
    LiveResult live = run_live({stream, config, options}, system, log);
    SequenceRun run = log.finish(system);
    run.live_record = std::move(live.record);
    run.report.live = std::move(live.report);
    return run;
  }
  FramePreparation prepared(stream,
                            ObjectSource(options.segmenter, config.dynamics.object_tracking()),
                            system,
                            options.threads > 1,
                            options.probe);
  run_through(system, log, prepared);
  return log.finish(system);
}

}  // namespace stillmap
