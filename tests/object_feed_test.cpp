// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/object_feed.hpp"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "tests/support/live_runs.hpp"

namespace stillmap {
namespace {

// Finds in each frame one object, whose score tells the frame; waits to be let through.
class GatedSegmenter : public Segmenter {
 public:
  [[nodiscard]] FrameDetections segment(const ColorImage&, const Stamp& stamp) const override {
    std::unique_lock lock(mutex_);
    ++begun_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return let_through_ > 0; });
    --let_through_;
    ++ended_;
    if (fails_) throw Error("the network is broken");
    return {stamp, {{1, "person", static_cast<float>(stamp.seconds), {0, 0, 1, 1}}}, {}};
  }
  void let_through(int frames) {
    const std::lock_guard lock(mutex_);
    let_through_ += frames;
    changed_.notify_all();
  }
  void fail() { fails_ = true; }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  mutable int let_through_ = 0, begun_ = 0, ended_ = 0;
  bool fails_ = false;
};

FramePtr bare_frame(std::uint32_t i) {
  auto frame = std::make_shared<RgbdFrame>();
  frame->id = FrameId(i);
  frame->stamp = {static_cast<double>(i) / 100, "x"};
  return frame;
}

std::vector<std::uint32_t> ids_of(const ObjectFeedStep& step) {
  std::vector<std::uint32_t> ids;
  for (const auto& [frame, detections] : step.arrived) {
    ids.push_back(frame->id.value);
    EXPECT_EQ(detections.objects.at(0).score, static_cast<float>(frame->stamp.seconds));
  }
  return ids;
}

// Steps until the look has come in; a look that never does ends in the test's time limit.
ObjectFeedStep step_until_arrival(NetworkFeed& feed, std::uint32_t frame) {
  while (true) {
    ObjectFeedStep step = feed.step(bare_frame(frame++), {false, 1});
    if (!step.arrived.empty()) return step;
  }
}

TEST(NetworkFeed, WaitsForNothingWhileTheNetworkLooks) {
  GatedSegmenter segmenter;
  NetworkFeed feed(segmenter);
  EXPECT_TRUE(feed.step(bare_frame(0), {false, 1}).looking);
  for (std::uint32_t i = 1; i < 20; ++i) {
    const ObjectFeedStep step = feed.step(bare_frame(i), {false, 1});
    EXPECT_TRUE(step.arrived.empty());
    EXPECT_FALSE(step.looking);
  }
  segmenter.let_through(1);
  const ObjectFeedStep step = step_until_arrival(feed, 20);
  EXPECT_EQ(ids_of(step), std::vector<std::uint32_t>{0});
  EXPECT_TRUE(step.looking);  // at the frame of that step
  segmenter.let_through(1);
}

TEST(NetworkFeed, LeavesAGapBetweenLooks) {
  GatedSegmenter segmenter;
  segmenter.let_through(100);
  NetworkFeed feed(segmenter);
  std::vector<std::uint32_t> looked_at;
  for (std::uint32_t i = 0; i < 40; i += 2) {
    if (feed.step(bare_frame(i), {false, 5}).looking) looked_at.push_back(i);
  }
  for (std::size_t i = 1; i < looked_at.size(); ++i) {
    EXPECT_GE(looked_at[i], looked_at[i - 1] + 5);
  }
}

TEST(NetworkFeed, WaitsForTheOwnOfAFrameThatNeedsThem) {
  GatedSegmenter segmenter;
  segmenter.let_through(2);
  NetworkFeed feed(segmenter);
  EXPECT_TRUE(feed.step(bare_frame(3), {false, 30}).looking);
  const ObjectFeedStep step = feed.step(bare_frame(4), {true, 30});
  EXPECT_FALSE(step.looking);
  EXPECT_EQ(step.arrived.back().first->id, FrameId(4));
  EXPECT_EQ(ids_of(step).size(), 2U);  // and those of the look that was under way, first
}

TEST(NetworkFeed, HandsTheNetworksErrorOn) {
  GatedSegmenter segmenter;
  segmenter.fail();
  segmenter.let_through(1);
  NetworkFeed feed(segmenter);
  EXPECT_EQ(error_of([&] { (void)feed.step(bare_frame(0), {true, 1}); }), "the network is broken");
}

TEST(NetworkFeed, CanBeGivenUpWhileTheNetworkLooks) {
  GatedSegmenter segmenter;
  NetworkFeed feed(segmenter);
  (void)feed.step(bare_frame(0), {false, 1});
  segmenter.let_through(1);
}

TEST(RecordedFeed, GivesTheSameAtTheSameSteps) {
  GatedSegmenter segmenter;
  segmenter.let_through(100);
  RecordedFeed feed(segmenter,
                    {{FrameId(0), {FrameId(0)}},
                     {FrameId(1), {}},
                     {FrameId(4), {}},
                     {FrameId(5), {FrameId(1)}},
                     {FrameId(6), {FrameId(5), FrameId(6)}}});
  const auto step = [&](std::uint32_t i, bool needs_own) {
    return feed.step(bare_frame(i), {needs_own, 1});
  };
  const ObjectFeedStep first = step(0, true);
  EXPECT_EQ(ids_of(first), std::vector<std::uint32_t>{0});
  EXPECT_FALSE(first.looking);
  EXPECT_TRUE(step(1, false).looking);
  EXPECT_FALSE(step(4, false).looking);
  const ObjectFeedStep fourth = step(5, false);
  EXPECT_EQ(ids_of(fourth), std::vector<std::uint32_t>{1});
  EXPECT_TRUE(fourth.looking);
  const ObjectFeedStep last = step(6, true);
  EXPECT_EQ(ids_of(last), (std::vector<std::uint32_t>{5, 6}));
  EXPECT_FALSE(last.looking);
}

TEST(RecordedFeed, OfARunWithOtherSettingsIsRefused) {
  GatedSegmenter segmenter;
  RecordedFeed feed(segmenter, {{FrameId(3), {}}});
  EXPECT_THAT(error_of([&] {
                (void)feed.step(bare_frame(3), {true, 1});
              }),
              testing::HasSubstr("the record has no objects of frame 3"));
}

}  // namespace
}  // namespace stillmap
