// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/run_sequence.hpp"

#include <algorithm>
#include <charconv>

#include "stillmap/core/error.hpp"
#include "tooling/pipeline/frame_preparation.hpp"
#include "tooling/pipeline/run_live.hpp"
#include "tooling/pipeline/run_log.hpp"

namespace stillmap {
namespace {

std::vector<FrameId> select_frames(const TumSequence& sequence, const FrameSelection& selection) {
  const std::size_t end = std::min(selection.end.value_or(sequence.size()), sequence.size());
  std::vector<FrameId> frames;
  for (std::size_t i = selection.begin; i < end; i += selection.stride) {
    frames.emplace_back(static_cast<std::uint32_t>(i));
  }
  if (frames.empty()) {
    throw Error("--frames begins at {}, but {} has only {} frames",
                selection.begin,
                sequence.folder().string(),
                sequence.size());
  }
  return frames;
}

// As fast as it goes, no frame left out.
void run_through(System& system, RunLog& log, FramePreparation& prepared) {
  while (std::optional<PreparedFrames> next = prepared.next()) {
    if (!next->at_end) log.add_stage_time("reading", next->source.reading_ms);
    if (!next->source.damage.empty()) log.skip(next->source);
    if (next->segmentation_ms) log.add_stage_time("segmentation", *next->segmentation_ms);
    for (PreparedFrame& ready : next->ready) {
      const FramePtr frame = ready.frame;
      log.add(*frame, system.process(std::move(ready)));
    }
  }
}

}  // namespace

FrameSelection parse_frames(const std::string& text) {
  const Error bad("--frames {}: expected A:B with A < B, counted from 0, such as 0:100 or 50:",
                  text);
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) throw bad;
  const auto number = [&](std::string_view digits) {
    std::size_t value = 0;
    const auto [last, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || last != digits.data() + digits.size()) throw bad;
    return value;
  };
  const std::string_view begin = std::string_view(text).substr(0, colon);
  const std::string_view end = std::string_view(text).substr(colon + 1);
  FrameSelection selection;
  if (!begin.empty()) selection.begin = number(begin);
  if (!end.empty()) selection.end = number(end);
  if (selection.end && *selection.end <= selection.begin) throw bad;
  return selection;
}

SequenceRun run_sequence(const TumSequence& sequence,
                         const SystemConfig& config,
                         RunOptions options) {
  const std::vector<FrameId> frames = select_frames(sequence, options.frames);
  RunLog log(sequence, config, options, frames.size());
  System system(config, sequence.camera(), {options.threads, options.localize_only, options.probe});
  if (options.start) system.load(std::move(*options.start));
  if (options.live) {
    LiveResult live = run_live({sequence, frames, config, options}, system, log);
    SequenceRun run = log.finish(system);
    run.live_record = std::move(live.record);
    run.report.live = std::move(live.report);
    return run;
  }
  FramePreparation prepared(FrameSource(sequence, frames, options.probe),
                            ObjectSource(options.segmenter, config.dynamics.object_tracking()),
                            system,
                            options.threads > 1);
  run_through(system, log, prepared);
  return log.finish(system);
}

}  // namespace stillmap
