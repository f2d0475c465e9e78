// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/run_log.hpp"

#include <algorithm>

#include <sys/resource.h>

#include "stillmap/core/error.hpp"
#include "tooling/eval/map_alignment.hpp"
#include "tooling/eval/pose_at.hpp"
#include "tooling/pipeline/sample_frame.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kSamples = 8;
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

}  // namespace

RunLog::RunLog(const FrameStream& stream, const SystemConfig& config, const RunOptions& options)
    : stream_(stream), options_(options) {
  with_objects_ = options.segmenter != nullptr && dynamics_mode(config.dynamics.mode).judges;
  run_.report.frames_total = stream.size().value();
  run_.report.dynamics_mode = config.dynamics.mode;
}

void RunLog::add_stage_time(std::string_view stage, double ms) {
  std::vector<StageTimes>& stages = run_.report.stages;
  const auto at = std::ranges::find(stages, stage, &StageTimes::name);
  if (at != stages.end()) {
    at->ms.push_back(ms);
  } else {
    stages.push_back({std::string(stage), {ms}});
  }
}

void RunLog::add(const RgbdFrame& frame, const FrameResult& result) {
  RunReport& report = run_.report;
  report.frame_ms.push_back(result.pose_ms);
  report.tracked_features.push_back(result.tracked_features);
  for (const StageTime& time : result.stages) add_stage_time(time.stage, time.ms);
  if (!has_pose(result)) report.lost.push_back(frame.stamp);
  if (with_objects_) objects_.push_back(log_frame(result));
  const std::size_t total = report.frames_total;
  if (done_ * kSamples / total != (done_ + 1) * kSamples / total) {
    report.samples.push_back(make_sample(frame, result));
  }
  pass(1);
}

void RunLog::pass(std::size_t frames) {
  done_ += frames;
  if (options_.on_progress) options_.on_progress(done_, run_.report.frames_total);
}

void RunLog::skip(const DamagedFrame& damaged) {
  RunReport& report = run_.report;
  report.skipped.push_back({damaged.stamp, damaged.damage});
  const std::size_t allowed = report.frames_total / kFramesPerDamaged;
  if (report.skipped.size() > allowed) {
    throw Error("{} ({} damaged so far; at most {} of {} frames may be)",
                damaged.damage,
                report.skipped.size(),
                allowed,
                report.frames_total);
  }
  warn("frame skipped: " + damaged.damage);
  pass(1);
}

void RunLog::warn(const std::string& warning) {
  run_.report.warnings.push_back(warning);
  if (options_.on_warning) options_.on_warning(warning);
}

SequenceRun RunLog::finish(System& system) {
  Stopwatch finishing;
  run_.result = system.finish();
  add_stage_time("finishing", finishing.lap_ms());
  RunReport& report = run_.report;
  const RunResult& result = run_.result;
  if (with_objects_) {
    run_.objects_jsonl = objects_jsonl(objects_, result.trajectory);
    report.objects = summarize_objects(objects_);
  }
  report.camera = stream_.camera();
  report.camera.readout_s = system.readout_s();
  report.frames_tracked = result.trajectory.size();
  report.estimate = result.trajectory;
  report.keyframes = result.keyframes;
  report.frames_elsewhere = result.frames_elsewhere;
  for (const ClosedLoop& loop : result.loops) report.loops.push_back({loop.earlier, loop.later});
  report.peak_memory_mb = peak_memory_mb();
  if (report.frames_elsewhere > 0) {
    warn(fmt::format(
        "{} frames were tracked after a loss in a map of their own, which no known place "
        "joins to this one: they are not in the results",
        report.frames_elsewhere));
  }
  report.wall_s = wall_.lap_ms() / 1000.0;
  if (options_.groundtruth) add_map_at_true_poses(run_, system, *options_.groundtruth);
  run_.session = system.take_session();
  return std::move(run_);
}

}  // namespace stillmap
