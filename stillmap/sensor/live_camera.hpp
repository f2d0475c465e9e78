// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

#include "stillmap/concurrency/prefetcher.hpp"
#include "stillmap/sensor/clock.hpp"
#include "stillmap/sensor/frame_source.hpp"
#include "stillmap/sensor/tum_sequence.hpp"

namespace stillmap {

/// A frame, and when the camera gave it.
struct CapturedFrame {
  SourcedFrame source;
  double arrival_s = 0;  ///< of the camera's clock
};

/// A sequence as a camera gives it: each frame at its time, and only the newest waits. Frames that
/// were not fetched before the next came are dropped.
class LiveCamera {
 public:
  /// Time goes `speed` times as fast as the stamps say; it begins with the first call of next().
  /// The sequence and the clock outlive the camera. Images are decoded ahead on a thread of their
  /// own, also those of frames that are dropped, as a driver does.
  LiveCamera(FrameSource source, const TumSequence& sequence, double speed, Clock& clock);

  /// The newest frame that has not been given; waits when there is none yet. Nothing at the end.
  /// Throws what reading throws.
  [[nodiscard]] std::optional<CapturedFrame> next();

  /// Frames that nobody has fetched in time.
  [[nodiscard]] std::size_t dropped() const { return dropped_; }

 private:
  void read_one();

  static constexpr std::size_t kAhead = 4;
  const TumSequence& sequence_;
  double speed_;
  Clock& clock_;
  FrameSource source_;
  Prefetcher<SourcedFrame> read_;  // after the source, which its thread uses
  std::optional<CapturedFrame> coming_;
  std::optional<double> begin_s_;  // of the clock
  double first_stamp_s_ = 0;
  std::size_t dropped_ = 0;
};

}  // namespace stillmap
