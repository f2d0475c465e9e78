// SPDX-License-Identifier: Apache-2.0
// The stages of a run work beside each other: none of them, however slow, changes a bit of the
// result, and what fails in any ends the run with its message.
#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/run/run_sequence.hpp"
#include "tests/live_test_support.hpp"

namespace stillmap {
namespace {

constexpr std::array kStages = {
    Stage::kReading, Stage::kPreparation, Stage::kTracking, Stage::kMapping, Stage::kViews};

// Calls a part of the wall a person; may take its time.
class PersonSegmenter : public Segmenter {
 public:
  explicit PersonSegmenter(std::chrono::milliseconds time = {}) : time_(time) {}
  [[nodiscard]] FrameDetections segment(const ColorImage& color,
                                        const Stamp& stamp) const override {
    std::this_thread::sleep_for(time_);
    ObjectMask mask(cv::Mat1b(color.mat.size(), std::uint8_t{0}));
    mask.mat(cv::Rect(10, 10, 60, 100)).setTo(1);
    return {stamp, {{1, "person", 0.9F, {10, 10, 70, 110}}}, mask};
  }

 private:
  std::chrono::milliseconds time_;
};

SequenceRun run_wall(const Segmenter& segmenter, int threads, StageProbe probe) {
  SystemConfig config;
  config.keyframe.max_gap_frames = 6;  // so that there is always something to map
  RunOptions options;
  options.segmenter = &segmenter;
  options.threads = threads;
  options.probe = std::move(probe);
  return run_sequence(wall_sequence(), config, std::move(options));
}

void expect_same(const SequenceRun& a, const SequenceRun& b) {
  ASSERT_EQ(a.result.trajectory.size(), b.result.trajectory.size());
  for (std::size_t i = 0; i < a.result.trajectory.size(); ++i) {
    EXPECT_EQ(a.result.trajectory[i].T_world_camera.matrix(),
              b.result.trajectory[i].T_world_camera.matrix());
  }
  EXPECT_GT(a.result.keyframes.size(), 2U);
  EXPECT_EQ(a.result.keyframes.size(), b.result.keyframes.size());
  EXPECT_TRUE(a.result.map.positions == b.result.map.positions);
  EXPECT_TRUE(a.result.map.colors == b.result.map.colors);
  EXPECT_EQ(a.objects_jsonl, b.objects_jsonl);
}

// Some pieces of work of a stage take much longer than others.
StageProbe slow(Stage slow_stage) {
  const auto count = std::make_shared<std::atomic<std::uint32_t>>(0);
  return [slow_stage, count](Stage stage) {
    if (stage != slow_stage) return;
    const std::uint32_t n = (*count)++;
    std::this_thread::sleep_for(std::chrono::milliseconds((n * 7919U) % 5U == 0U ? 40 : n % 4U));
  };
}

TEST(Pipeline, SlowStagesDoNotChangeABit) {
  const PersonSegmenter segmenter;
  const SequenceRun plain = run_wall(segmenter, 1, {});
  for (const Stage stage : kStages) {
    for (const int threads : {2, 4}) {
      SCOPED_TRACE(fmt::format("stage {}, {} threads", static_cast<int>(stage), threads));
      expect_same(plain, run_wall(segmenter, threads, slow(stage)));
    }
  }
  expect_same(plain, run_wall(PersonSegmenter(std::chrono::milliseconds(15)), 2, {}));
}

TEST(Pipeline, AnErrorInAnyStageEndsTheRunWithItsMessage) {
  const PersonSegmenter segmenter;
  for (const Stage broken : kStages) {
    for (const int threads : {1, 2, 4}) {
      SCOPED_TRACE(fmt::format("stage {}, {} threads", static_cast<int>(broken), threads));
      std::atomic<int> count = 0;
      const std::string text = error_of([&] {
        (void)run_wall(segmenter, threads, [&](Stage stage) {
          if (stage == broken && ++count == 3) {
            throw Error("stage {} is broken", static_cast<int>(stage));
          }
        });
      });
      EXPECT_EQ(text, fmt::format("stage {} is broken", static_cast<int>(broken)));
    }
  }
}

}  // namespace
}  // namespace stillmap
