// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "stillmap/io/io_test_support.hpp"
#include "stillmap/io/tum_sequence.hpp"
#include "stillmap/run/clock.hpp"
#include "tests/plane_sequence.hpp"

namespace stillmap {

/// Time passes only when somebody waits or a test says so.
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
inline const TumSequence& wall_sequence() {
  static const TemporaryFolder kFolder;
  static const TumSequence kSequence = [] {
    write_plane_sequence(kFolder.path(), static_cast<int>(kWallFrames));
    return TumSequence::open(kFolder.path());
  }();
  return kSequence;
}

inline std::vector<FrameId> wall_frames() {
  std::vector<FrameId> frames;
  for (std::uint32_t i = 0; i < kWallFrames; ++i) frames.emplace_back(i);
  return frames;
}

}  // namespace stillmap
