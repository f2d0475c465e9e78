// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <thread>

#include "stillmap/concurrency/newest.hpp"
#include "stillmap/concurrency/stage_probe.hpp"
#include "stillmap/sensor/clock.hpp"
#include "stillmap/sensor/frame_stream.hpp"

namespace stillmap {

/// Takes the frames of a stream that waits for them itself, as that of a device does: each as soon
/// as it is there, and only the newest waits. A frame that is not fetched before the next one comes
/// is dropped. ClockedStream does the same for recordings.
class ArrivingStream : public FrameStream {
 public:
  /// Calls `stream.next()` and `probe` on a thread of its own, which the destructor waits for: so
  /// until the frame after the last one fetched. `stream` and `clock` outlive the object; the clock
  /// is read on both threads.
  ArrivingStream(FrameStream& stream, Clock& clock, StageProbe probe = {});
  ~ArrivingStream() override { newest_.cancel(); }

  [[nodiscard]] const CameraModel& camera() const override { return stream_.camera(); }
  [[nodiscard]] std::optional<std::size_t> size() const override { return stream_.size(); }
  [[nodiscard]] bool ended_early() const override { return stream_.ended_early(); }

  /// The newest frame that was not returned yet; waits until one arrives. Nothing at the end.
  /// Throws what reading throws.
  [[nodiscard]] std::optional<StreamedFrame> next() override;

  /// The arrival of the frame that next() returned last, in seconds of the clock.
  [[nodiscard]] double arrival_s() const { return arrival_s_; }

  /// The number of frames that were not fetched in time.
  [[nodiscard]] std::size_t dropped() const { return dropped_; }

 private:
  struct Arrived {
    StreamedFrame frame;
    double time_s;
  };
  void read();

  FrameStream& stream_;
  Clock& clock_;
  StageProbe probe_;
  double arrival_s_ = 0;
  std::size_t dropped_ = 0;
  Newest<Arrived> newest_;
  std::jthread reader_;  // last member: it uses the others until it is joined
};

}  // namespace stillmap
