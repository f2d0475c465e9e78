// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/run_log.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <sys/resource.h>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/motion/modes.hpp"
#include "tooling/browser/logged_frames.hpp"
#include "tooling/eval/map_alignment.hpp"
#include "tooling/eval/pose_at.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kFramesPerDamaged = 50;

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
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
  run.map_at_true_poses = system.map_with_poses(poses);
}

// `own` first; null observers are left out.
std::vector<Observer*> both(std::vector<Observer*> own, std::span<Observer* const> others) {
  own.insert(own.end(), others.begin(), others.end());
  std::erase(own, nullptr);
  return own;
}

// Of all that is known of the frames at the end of a run, what its report shows.
std::vector<ViewedFrame> viewed_frames(const SequenceRun& run) {
  constexpr std::size_t kMostFrames = 1200;
  return logged_frames(
      {.trajectory = run.result.trajectory,
       .keyframes = run.result.keyframes,
       .objects_jsonl = run.objects_jsonl ? std::string_view(*run.objects_jsonl) : "",
       .objects_name = "objects.jsonl",
       .camera = run.report.camera,
       .lost = run.report.lost},
      kMostFrames);
}

}  // namespace

RunLog::RunLog(const FrameStream& stream,
               const SystemConfig& config,
               const RunOptions& options,
               std::span<Observer* const> observers)
    : stream_(stream),
      options_(options),
      dynamics_mode_(config.dynamics.mode),
      samples_(stream.size()),
      watch_(config.dynamics.objects.categories,
             [this](const std::string& warning) { all_.on_warning(warning); }),
      frame_watch_(config.measurement.max_depth_m,
                   [this](const std::string& warning) { all_.on_warning(warning); }),
      with_objects_(options.segmenter != nullptr && dynamics_mode(config.dynamics.mode).judges),
      all_(both({&timing_,
                 &frames_,
                 &samples_,
                 with_objects_ ? &objects_ : nullptr,
                 with_objects_ ? &watch_ : nullptr,
                 &frame_watch_},
                observers)) {}

void RunLog::skip(const DamagedFrame& damaged) {
  all_.on_damaged(damaged);
  // For a stream of unknown length: the frames so far, and at least one damaged frame is allowed.
  const std::optional<std::size_t> total = stream_.size();
  const std::size_t allowed =
      total ? *total / kFramesPerDamaged : 1 + frames_.frames() / kFramesPerDamaged;
  if (frames_.damaged() > allowed) {
    throw Error("{} ({} damaged so far; at most {} of {} frames may be)",
                damaged.damage,
                frames_.damaged(),
                allowed,
                total.value_or(frames_.frames()));
  }
  all_.on_warning("frame skipped: " + damaged.damage);
}

SequenceRun RunLog::finish(System& system) {
  SequenceRun run;
  Stopwatch finishing;
  run.result = system.finish();
  all_.on_stage_time("finishing", finishing.lap_ms());
  const RunResult& result = run.result;
  for (const std::string& warning : stream_.warnings()) all_.on_warning(warning);
  if (result.frames_elsewhere > 0) {
    all_.on_warning(fmt::format(
        "{} frames were tracked after a loss in a map of their own, which no known place "
        "joins to this one: they are not in the results",
        result.frames_elsewhere));
  }

  RunReport& report = run.report;
  report.dynamics_mode = dynamics_mode_;
  report.frames_total = stream_.size().value_or(frames_.frames());
  timing_.fill(report);
  frames_.fill(report);
  samples_.fill(report);
  if (with_objects_) {
    run.objects_jsonl = objects_.jsonl(result.trajectory);
    report.objects = objects_.summaries();
    report.first_dynamic_s = watch_.first_dynamic_s();
  }
  report.camera = stream_.camera();
  report.camera.readout_s = system.readout_s();
  report.depth_delay_s = system.depth_delay_s();
  report.frames_tracked = result.trajectory.size();
  report.estimate = result.trajectory;
  report.keyframes = result.keyframes;
  report.viewed = viewed_frames(run);
  report.frames_elsewhere = result.frames_elsewhere;
  report.vacated = result.vacated;
  report.loops = result.loops;
  report.peak_memory_mb = peak_memory_mb();
  report.wall_s = wall_.lap_ms() / 1000.0;
  if (options_.groundtruth) add_map_at_true_poses(run, system, *options_.groundtruth);
  run.session = system.take_session();
  return run;
}

}  // namespace stillmap
