// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <thread>

#include "stillmap/core/error.hpp"
#include "stillmap/sensor/clock.hpp"
#include "stillmap/sensor/sequence_stream.hpp"
#include "tests/support/files.hpp"
#include "tests/support/plane_sequence.hpp"
#include "tooling/pipeline/run_sequence.hpp"

namespace stillmap {

/// A clock that advances only when a caller waits or a test says so.
class TestClock : public Clock {
 public:
  [[nodiscard]] double now_s() override { return now_s_; }
  void wait_until_s(double time_s) override {
    if (time_s > now_s_) now_s_ = time_s;
  }
  void pass_s(double seconds) { now_s_ += seconds; }

 private:
  double now_s_ = 1000;
};

/// The wall of plane_sequence.hpp, 30 frames.
inline constexpr std::size_t kWallFrames = 30;
inline constexpr double kWallPeriod_s = 1 / 30.0;
inline const Sequence& wall_sequence() {
  static const TemporaryFolder kFolder;
  static const Sequence kSequence = [] {
    write_plane_sequence(kFolder.path(), static_cast<int>(kWallFrames));
    return Sequence::open(kFolder.path());
  }();
  return kSequence;
}

/// Detects a part of the wall as a person, after some time; optionally fails from a stamp on.
class StandInSegmenter : public Segmenter {
 public:
  explicit StandInSegmenter(std::chrono::milliseconds time = {}, double fails_at_s = 1e9)
      : time_(time), fails_at_s_(fails_at_s) {}

  [[nodiscard]] FrameDetections segment(const ColorImage& color,
                                        const Stamp& stamp) const override {
    std::this_thread::sleep_for(time_);
    if (stamp.seconds >= fails_at_s_) throw Error("the network is broken");
    ObjectMask mask(cv::Mat1b(color.mat.size(), std::uint8_t{0}));
    mask.mat(cv::Rect(10, 10, 60, 100)).setTo(1);
    return {stamp, {{1, "person", 0.9F, {10, 10, 70, 110}}}, mask};
  }

 private:
  std::chrono::milliseconds time_;
  double fails_at_s_;
};

/// Expects two runs to be equal bit by bit.
inline void expect_same(const SequenceRun& a, const SequenceRun& b) {
  ASSERT_EQ(a.result.trajectory.size(), b.result.trajectory.size());
  for (std::size_t i = 0; i < a.result.trajectory.size(); ++i) {
    EXPECT_EQ(a.result.trajectory[i].stamp.text, b.result.trajectory[i].stamp.text);
    EXPECT_EQ(a.result.trajectory[i].T_world_camera.matrix(),
              b.result.trajectory[i].T_world_camera.matrix());
  }
  EXPECT_EQ(a.result.keyframes.size(), b.result.keyframes.size());
  EXPECT_TRUE(a.result.map.positions == b.result.map.positions);
  EXPECT_TRUE(a.result.map.colors == b.result.map.colors);
  EXPECT_EQ(a.objects_jsonl, b.objects_jsonl);
  EXPECT_EQ(a.live_record, b.live_record);
}

}  // namespace stillmap
