// SPDX-License-Identifier: Apache-2.0
// The stages of a run work beside each other: none of them, however slow, changes a bit of the
// result, and what fails in any ends the run with its message.
#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "tests/support/live_runs.hpp"
#include "tooling/pipeline/run_sequence.hpp"

namespace stillmap {
namespace {

constexpr std::array kStages = {
    Stage::kReading, Stage::kPreparation, Stage::kTracking, Stage::kMapping, Stage::kViews};

SequenceRun run_wall(const Segmenter& segmenter, int threads, StageProbe probe) {
  SystemConfig config;
  config.keyframe.max_gap_frames = 6;  // so that there is always something to map
  RunOptions options;
  options.segmenter = &segmenter;
  options.threads = threads;
  options.probe = std::move(probe);
  SequenceStream wall(wall_sequence());
  return run_sequence(wall, config, std::move(options));
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
  const StandInSegmenter segmenter;
  const SequenceRun plain = run_wall(segmenter, 1, {});
  EXPECT_GT(plain.result.keyframes.size(), 2U);
  for (const Stage stage : kStages) {
    for (const int threads : {2, 4}) {
      SCOPED_TRACE(fmt::format("stage {}, {} threads", static_cast<int>(stage), threads));
      expect_same(plain, run_wall(segmenter, threads, slow(stage)));
    }
  }
  expect_same(plain, run_wall(StandInSegmenter(std::chrono::milliseconds(15)), 2, {}));
}

TEST(Pipeline, AnErrorInAnyStageEndsTheRunWithItsMessage) {
  const StandInSegmenter segmenter;
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
