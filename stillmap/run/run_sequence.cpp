// SPDX-License-Identifier: Apache-2.0
#include "stillmap/run/run_sequence.hpp"

#include <algorithm>
#include <charconv>

#include <sys/resource.h>

#include "stillmap/core/error.hpp"
#include "stillmap/eval/map_alignment.hpp"
#include "stillmap/eval/pose_at.hpp"
#include "stillmap/run/frame_preparation.hpp"
#include "stillmap/run/object_log.hpp"
#include "stillmap/run/sample_frame.hpp"
#include "stillmap/system/stopwatch.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kSamples = 8;
constexpr std::size_t kFramesPerDamaged = 50;

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

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void add_stage_time(std::vector<StageTimes>& stages, std::string_view name, double ms) {
  const auto at = std::ranges::find(stages, name, &StageTimes::name);
  if (at != stages.end()) {
    at->ms.push_back(ms);
  } else {
    stages.push_back({std::string(name), {ms}});
  }
}

void add_frame(RunReport& report, const RgbdFrame& frame, const FrameResult& result) {
  report.frame_ms.push_back(result.pose_ms);
  report.tracked_features.push_back(result.tracked.inliers);
  for (const StageTime& time : result.stages) add_stage_time(report.stages, time.stage, time.ms);
  if (!has_pose(result.tracked)) report.lost.push_back(frame.stamp);
}

void skip_frame(RunReport& report,
                const Stamp& stamp,
                const std::string& damage,
                const RunOptions& options) {
  report.skipped.push_back({stamp, damage});
  const std::size_t allowed = report.frames_total / kFramesPerDamaged;
  if (report.skipped.size() > allowed) {
    throw Error("{} ({} damaged so far; at most {} of {} frames may be)",
                damage,
                report.skipped.size(),
                allowed,
                report.frames_total);
  }
  report.warnings.push_back("frame skipped: " + damage);
  if (options.on_warning) options.on_warning(report.warnings.back());
}

void add_map_at_true_poses(SequenceRun& run, const System& system, const Trajectory& truth) {
  const std::optional<Eigen::Isometry3d> alignment = map_alignment(truth, run.result.trajectory);
  if (!alignment) return;
  const Eigen::Isometry3d T_world_truth = alignment->inverse();
  std::vector<std::optional<Eigen::Isometry3d>> poses;
  for (const StampedPose& frame : run.result.trajectory) {
    poses.push_back(pose_at(truth, frame.stamp.seconds));
    if (poses.back()) poses.back() = T_world_truth * *poses.back();
  }
  const auto unknown = std::ranges::count_if(poses, [](const auto& pose) { return !pose; });
  if (unknown > 0) {
    run.report.warnings.push_back(
        fmt::format("{} of {} frames have no true pose and add nothing to the map at true poses",
                    unknown,
                    poses.size()));
  }
  run.map_at_true_poses = system.cloud_with_poses(poses);
}

void warn_of_frames_elsewhere(RunReport& report, const RunOptions& options) {
  if (report.frames_elsewhere == 0) return;
  report.warnings.push_back(
      fmt::format("{} frames were tracked after a loss in a map of their own, which no known place "
                  "joins to this one: they are not in the results",
                  report.frames_elsewhere));
  if (options.on_warning) options.on_warning(report.warnings.back());
}

void finish_report(SequenceRun& run, const TumSequence& sequence, const System& system) {
  RunReport& report = run.report;
  report.camera = sequence.camera();
  report.camera.readout_s = system.readout_s();
  report.frames_tracked = run.result.trajectory.size();
  report.estimate = run.result.trajectory;
  report.keyframes = run.result.keyframes;
  report.frames_elsewhere = run.result.frames_elsewhere;
  for (const ClosedLoop& loop : run.result.loops)
    report.loops.push_back({loop.earlier, loop.later});
  report.peak_memory_mb = peak_memory_mb();
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
  Stopwatch wall;
  const std::vector<FrameId> frames = select_frames(sequence, options.frames);
  System system(config, sequence.camera(), {options.threads, options.localize_only});
  if (options.start) system.load(std::move(*options.start));
  SequenceRun run;
  RunReport& report = run.report;
  report.sequence = sequence.name();
  report.frames_total = frames.size();

  report.dynamics_mode = config.dynamics.mode;
  const bool with_objects = options.segmenter != nullptr && config.dynamics.mode != "off";

  std::vector<LoggedFrame> log;
  std::size_t done = 0;
  const auto process = [&](ReadyFrame ready) {
    const FrameResult result =
        system.process(ready.frame, std::move(ready.objects), std::move(ready.prepared));
    add_frame(report, *ready.frame, result);
    if (with_objects) log.push_back(log_frame(ready.frame->stamp, result));
    if (done * kSamples / frames.size() != (done + 1) * kSamples / frames.size()) {
      report.samples.push_back(make_sample(*ready.frame, result));
    }
    ++done;
    if (options.on_progress) options.on_progress(done, frames.size());
  };
  FramePreparation frames_ahead(
      FrameSource(sequence, frames),
      ObjectSource(options.segmenter,
                   config.dynamics.object_tracking(),
                   options.live ? FillRule::kCausal : FillRule::kBothWays),
      system,
      options.threads > 1);
  while (std::optional<PreparedFrames> next = frames_ahead.next()) {
    if (!next->at_end) add_stage_time(report.stages, "reading", next->source.reading_ms);
    if (!next->source.damage.empty()) {
      skip_frame(report, sequence.entry(next->source.id).stamp, next->source.damage, options);
      ++done;
    }
    if (next->segmentation_ms) {
      add_stage_time(report.stages, "segmentation", *next->segmentation_ms);
    }
    for (ReadyFrame& frame : next->ready) process(std::move(frame));
  }
  Stopwatch finishing;
  run.result = system.finish();
  add_stage_time(report.stages, "finishing", finishing.lap_ms());
  if (with_objects) {
    run.objects_jsonl = objects_jsonl(log, run.result.trajectory);
    report.objects = summarize_objects(log);
  }
  finish_report(run, sequence, system);
  warn_of_frames_elsewhere(report, options);
  report.wall_s = wall.lap_ms() / 1000.0;
  if (options.groundtruth) add_map_at_true_poses(run, system, *options.groundtruth);
  run.session = system.take_session();
  return run;
}

}  // namespace stillmap
