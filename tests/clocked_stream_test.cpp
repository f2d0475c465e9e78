// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/clocked_stream.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/live_runs.hpp"

namespace stillmap {
namespace {

struct Given {
  std::vector<std::uint32_t> frames;
  std::vector<double> at_s;  // since the first
  std::size_t dropped = 0;
};

// What a camera gives to somebody who takes so long for each frame.
Given take_all(double speed, const std::vector<double>& work_s) {
  TestClock clock;
  SequenceStream wall(wall_sequence());
  ClockedStream camera(wall, speed, clock);
  Given given;
  const double begin_s = clock.now_s();
  while (const std::optional<StreamedFrame> frame = camera.next()) {
    EXPECT_NE(std::get<FramePtr>(*frame), nullptr);
    EXPECT_LE(camera.arrival_s(), clock.now_s());
    given.at_s.push_back(clock.now_s() - begin_s);
    clock.pass_s(work_s[given.frames.size() % work_s.size()]);
    given.frames.push_back(id_of(*frame).value);
  }
  given.dropped = camera.dropped();
  return given;
}

TEST(ClockedStream, GivesEveryFrameAtItsTimeToWhoeverIsFast) {
  for (const double speed : {1.0, 4.0}) {
    const Given given = take_all(speed, {0.001 / speed});
    ASSERT_EQ(given.frames.size(), kWallFrames);
    EXPECT_EQ(given.dropped, 0U);
    for (std::size_t i = 0; i < kWallFrames; ++i) {
      EXPECT_EQ(given.frames[i], i);
      EXPECT_NEAR(given.at_s[i], static_cast<double>(i) / 30.0 / speed, 2e-6);
    }
  }
}

// Worked out by hand from "the newest waits, those before it are dropped".
TEST(ClockedStream, DropsWhatCameWhileSomebodyWasBusy) {
  const std::vector<double> work_s = {0.050, 0.005, 0.210, 0.030, 0.034};
  const Given given = take_all(1.0, work_s);
  std::vector<std::uint32_t> expected;
  double now_s = 0;
  for (std::size_t next = 0; next < kWallFrames;) {
    const auto arrival_s = [](std::size_t i) { return static_cast<double>(i) / 30.0; };
    now_s = std::max(now_s, arrival_s(next));
    while (next + 1 < kWallFrames && arrival_s(next + 1) <= now_s) ++next;
    now_s += work_s[expected.size() % work_s.size()];
    expected.push_back(static_cast<std::uint32_t>(next++));
  }
  EXPECT_EQ(given.frames, expected);
  EXPECT_EQ(given.dropped, kWallFrames - expected.size());
  EXPECT_GT(given.dropped, 5U);
}

TEST(ClockedStream, OneLateFrameCostsNothingIfTheNextIsFast) {
  std::vector<double> work_s(kWallFrames, 0.010);
  work_s[7] = 0.060;
  EXPECT_EQ(take_all(1.0, work_s).dropped, 0U);
  work_s[7] = 0.070;
  EXPECT_EQ(take_all(1.0, work_s).dropped, 1U);
}

// Frames with the stamps given, and nothing in their images.
class StampedStream : public FrameStream {
 public:
  explicit StampedStream(std::vector<double> stamps_s) : stamps_s_(std::move(stamps_s)) {}
  [[nodiscard]] const CameraModel& camera() const override { return camera_; }
  [[nodiscard]] std::optional<StreamedFrame> next() override {
    if (next_ == stamps_s_.size()) return std::nullopt;
    auto frame = std::make_shared<RgbdFrame>();
    frame->id = FrameId(static_cast<std::uint32_t>(next_));
    frame->stamp.seconds = stamps_s_[next_++];
    return frame;
  }

 private:
  CameraModel camera_;
  std::vector<double> stamps_s_;
  std::size_t next_ = 0;
};

TEST(ClockedStream, DoesNotWaitForLongPauses) {
  TestClock clock;
  StampedStream stream({0, 9, 18.5, 1e9, 2e9, 2e9 + 0.25});
  ClockedStream camera(stream, 2, clock);
  const double begin_s = clock.now_s();
  std::vector<double> at_s;
  while (camera.next()) at_s.push_back(clock.now_s() - begin_s);
  ASSERT_EQ(at_s.size(), 6U);
  const std::vector<double> expected = {0, 4.5, 9.25, 9.75, 10.25, 10.375};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(at_s[i], expected[i], 1e-6) << i;
  EXPECT_NEAR(camera.skipped_s(), 2e9 - 18.5 - 2, 1e-3);
}

TEST(ClockedStream, CanBeGivenUp) {
  TestClock clock;
  SequenceStream wall(wall_sequence());
  ClockedStream camera(wall, 1, clock);
  EXPECT_TRUE(camera.next());
}

}  // namespace
}  // namespace stillmap
