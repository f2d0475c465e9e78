// SPDX-License-Identifier: Apache-2.0
// Live runs of a sequence, by a clock of the test, with a network that takes as long as it likes.
#include <chrono>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/live_runs.hpp"
#include "tooling/pipeline/run_sequence.hpp"

namespace stillmap {
namespace {

// Each frame takes `frame_s` of the clock.
class TimePasses : public Observer {
 public:
  TimePasses(TestClock& clock, double frame_s) : clock_(clock), frame_s_(frame_s) {}
  void on_frame(const RgbdFrame&, const FrameResult&) override { clock_.pass_s(frame_s_); }

 private:
  TestClock& clock_;
  double frame_s_;
};

// The network takes real time.
SequenceRun run_live_wall(const Segmenter* segmenter, double frame_s) {
  TestClock clock;
  RunOptions options;
  options.segmenter = segmenter;
  options.live.emplace();
  options.live->clock = &clock;
  TimePasses time_passes(clock, frame_s);
  SequenceStream wall(wall_sequence());
  return run_sequence(wall, {}, std::move(options), std::vector<Observer*>{&time_passes});
}

SequenceRun run_again(const Segmenter* segmenter, const LiveRecord& record, int threads) {
  RunOptions options;
  options.segmenter = segmenter;
  options.threads = threads;
  options.live.emplace();
  options.live->record = record;
  SequenceStream wall(wall_sequence());
  return run_sequence(wall, {}, std::move(options));
}

TEST(LiveRun, CanBeMadeAgainToTheBit) {
  for (const int network_ms : {0, 3, 20}) {
    const StandInSegmenter segmenter{std::chrono::milliseconds(network_ms)};
    const SequenceRun live = run_live_wall(&segmenter, 0.040);
    EXPECT_LT(live.live_record.size(), kWallFrames);  // some were dropped
    EXPECT_GT(live.report.live->looked_at, 0U);
    for (const int threads : {1, 2, 4}) {
      expect_same(live, run_again(&segmenter, live.live_record, threads));
    }
  }
}

TEST(LiveRun, WithoutANetworkNeedsNoMasks) {
  const SequenceRun live = run_live_wall(nullptr, 0.001);
  EXPECT_EQ(live.result.trajectory.size(), kWallFrames);
  EXPECT_EQ(live.report.live->looked_at, 0U);
  EXPECT_EQ(live.report.live->dropped, 0U);
  expect_same(live, run_again(nullptr, live.live_record, 2));
}

TEST(LiveRun, CountsWhatWasDropped) {
  const StandInSegmenter segmenter{std::chrono::milliseconds(1)};
  const SequenceRun live = run_live_wall(&segmenter, 0.100);
  const LiveReport& report = *live.report.live;
  EXPECT_EQ(report.dropped + live.live_record.size(), kWallFrames);
  EXPECT_GT(report.dropped, kWallFrames / 2);
  EXPECT_EQ(report.latency_ms.size(), live.live_record.size());
  EXPECT_EQ(run_again(&segmenter, live.live_record, 1).report.live->dropped, report.dropped);
}

// The first frame waits for its objects, and key frames are frames that were looked at.
TEST(LiveRun, KeyframesHaveMasksOfTheirOwn) {
  const StandInSegmenter segmenter{std::chrono::milliseconds(5)};
  const SequenceRun live = run_live_wall(&segmenter, 0.030);
  std::set<std::string> looked_at;
  for (const LiveStep& step : live.live_record) {
    for (const FrameId id : step.objects_of) {
      looked_at.insert(wall_sequence().entry(id).stamp.text);
    }
  }
  EXPECT_EQ(live.live_record.front().objects_of, std::vector{FrameId(0)});
  EXPECT_LT(looked_at.size(), live.live_record.size());
  ASSERT_FALSE(live.result.keyframes.empty());
  for (const StampedPose& keyframe : live.result.keyframes) {
    EXPECT_TRUE(looked_at.contains(keyframe.stamp.text)) << keyframe.stamp.text;
  }
}

TEST(LiveRun, EndsWithTheNetworksError) {
  const StandInSegmenter segmenter(std::chrono::milliseconds(1), 100.3);
  EXPECT_EQ(error_of([&] { (void)run_live_wall(&segmenter, 0.030); }), "the network is broken");
}

}  // namespace
}  // namespace stillmap
