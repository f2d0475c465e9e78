// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "stillmap/concurrency/prefetcher.hpp"
#include "stillmap/concurrency/stage_probe.hpp"
#include "stillmap/sensor/clock.hpp"
#include "stillmap/sensor/frame_stream.hpp"

namespace stillmap {

/// Plays another stream as a camera would: each frame arrives at its time, and only the newest
/// waits. A frame that is not fetched before the next one arrives is dropped. Nobody waits for a
/// recording that was paused, or whose stamps are not in seconds: a pause of more than 10 s between
/// two stamps becomes one of 1 s.
class ClockedStream : public FrameStream {
 public:
  /// Time passes `speed` times as fast as the stamps say; it begins with the first call of next().
  /// `stream` and `clock` outlive the object. The stream is read ahead on a thread of its own,
  /// frames that are dropped included, as a camera's driver does; `probe` is called there.
  ClockedStream(FrameStream& stream, double speed, Clock& clock, StageProbe probe = {});

  [[nodiscard]] const CameraModel& camera() const override { return stream_.camera(); }
  [[nodiscard]] std::optional<std::size_t> size() const override { return stream_.size(); }

  /// The newest frame that was not returned yet; waits until one arrives. Nothing at the end.
  /// Throws what reading throws.
  [[nodiscard]] std::optional<StreamedFrame> next() override;

  /// The arrival of the frame that next() returned last, in seconds of the clock.
  [[nodiscard]] double arrival_s() const { return arrival_s_; }

  /// What was left out of pauses, seconds of the stamps.
  [[nodiscard]] double skipped_s() const { return skipped_s_; }

  /// The number of frames that were not fetched in time.
  [[nodiscard]] std::size_t dropped() const { return dropped_; }

 private:
  void read_one();
  void take(std::optional<StreamedFrame>& frame);

  static constexpr std::size_t kAhead = 4;
  static constexpr double kLongestPauseS = 10, kCutPauseS = 1;
  FrameStream& stream_;
  double speed_;
  Clock& clock_;
  StageProbe probe_;
  Prefetcher<StreamedFrame> read_;  // after the probe, which its thread uses
  std::optional<StreamedFrame> coming_;
  double coming_arrival_s_ = 0;
  double arrival_s_ = 0;
  std::optional<double> begin_s_;  // of the clock
  double first_stamp_s_ = 0;       // moved by what was left out of pauses
  double last_stamp_s_ = 0;
  double skipped_s_ = 0;
  std::size_t dropped_ = 0;
};

}  // namespace stillmap
