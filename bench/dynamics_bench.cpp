// SPDX-License-Identifier: Apache-2.0
// The dynamics stage in mode `full`, in an office where people walk.
#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>

#include "bench/rendered_office.hpp"
#include "stillmap/perception/motion/dynamics_stage.hpp"
#include "stillmap/slam/features/orb_extractor.hpp"

namespace stillmap {
namespace {

constexpr std::uint32_t kPast = 100;  // frames: the stage looks back up to 80

/// The stage after `kPast` frames at true poses, with its input for the next two frames.
class Office {
 public:
  Office()
      : stage_(make_dynamics_stage({}, office().camera(), 0)),
        extractor_(OrbConfig{}, office().camera()) {
    ObjectTracker tracker(DynamicsConfig{}.object_tracking(), FillRule::kCausal);
    for (std::uint32_t step = 0; step < kPast + 2; ++step) {
      const FramePtr frame = office().frame(step);
      FrameObjects objects = *tracker.push({frame->id, office().found(step), frame->depth});
      if (step >= kPast) {
        next_.push_back(std::move(objects));
        continue;
      }
      const FrameDynamics dynamics = judge(step, std::move(objects));
      if (step + 1 == kPast) (void)filter(step, extract(step, dynamics), dynamics);
      (void)stage_->with_motion(*frame, office().T_world_camera(step), dynamics);
      stage_->remember(*frame, office().T_world_camera(step), dynamics);
    }
  }

  [[nodiscard]] const FrameObjects& objects(std::uint32_t next) const { return next_[next]; }
  [[nodiscard]] FrameDynamics judge(std::uint32_t step, FrameObjects objects) const {
    const FramePtr frame = office().frame(step);
    const MeasuredObjects measured = stage_->measure(*frame, objects);
    return stage_->judge(*frame, std::move(objects), measured, office().T_world_camera(step));
  }
  [[nodiscard]] Features extract(std::uint32_t step, const FrameDynamics& dynamics) {
    const FramePtr frame = office().frame(step);
    return extractor_.extract(frame->gray, frame->depth, dynamics.unsearched);
  }
  [[nodiscard]] FilteredFeatures filter(std::uint32_t step,
                                        Features features,
                                        const FrameDynamics& dynamics) {
    return stage_->filter(
        *office().frame(step), std::move(features), dynamics, office().T_world_camera(step));
  }
  void remember(std::uint32_t step, FrameDynamics& dynamics) {
    stage_->remember(*office().frame(step), office().T_world_camera(step), dynamics);
  }

 private:
  std::unique_ptr<DynamicsStage> stage_;
  OrbExtractor extractor_;
  std::vector<FrameObjects> next_;  // of the two frames after the past
};

void judge_frame(benchmark::State& state) {
  const Office scene;
  int dynamic_pixels = 0;
  for (auto iteration : state) {
    const FrameDynamics dynamics = scene.judge(kPast, scene.objects(0));
    dynamic_pixels = cv::countNonZero(dynamics.excluded.mat);
  }
  state.counters["objects"] = static_cast<double>(scene.objects(0).objects.size());
  state.counters["excluded_px"] = dynamic_pixels;
}

/// Alternates two frames, so that each is compared with the features of the other.
void sift_features(benchmark::State& state) {
  Office scene;
  std::vector<FrameDynamics> dynamics;
  std::vector<Features> features;
  for (std::uint32_t next = 0; next < 2; ++next) {
    dynamics.push_back(scene.judge(kPast + next, scene.objects(next)));
    features.push_back(scene.extract(kPast + next, dynamics[next]));
  }
  std::size_t kept = 0;
  std::uint32_t turn = 0;
  for (auto iteration : state) {
    const std::uint32_t next = turn++ % 2;
    kept = scene.filter(kPast + next, features[next], dynamics[next]).features.size();
  }
  state.counters["kept"] = static_cast<double>(kept);
  state.counters["of"] = static_cast<double>(features[(turn + 1) % 2].size());
}

/// The motion of objects, and remembering the frame for later comparison.
void remember_frame(benchmark::State& state) {
  Office scene;
  FrameDynamics dynamics = scene.judge(kPast, scene.objects(0));
  for (auto iteration : state) scene.remember(kPast, dynamics);
}

BENCHMARK(judge_frame)->Unit(benchmark::kMillisecond);
BENCHMARK(sift_features)->Unit(benchmark::kMillisecond);
BENCHMARK(remember_frame)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillmap
