// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "stillmap/sensor/frame_stream.hpp"

namespace stillmap {

/// Another stream, which ends before its next frame once an interruption has been noted.
class InterruptibleStream : public FrameStream {
 public:
  /// `stream` outlives the object.
  explicit InterruptibleStream(FrameStream& stream) : stream_(stream) {}

  [[nodiscard]] const CameraModel& camera() const override { return stream_.camera(); }
  /// Of a stream that ended early, the number of frames until then.
  [[nodiscard]] std::optional<std::size_t> size() const override;
  [[nodiscard]] std::optional<StreamedFrame> next() override;
  [[nodiscard]] bool ended_early() const override { return ended_early_; }
  [[nodiscard]] std::vector<std::string> warnings() const override { return stream_.warnings(); }
  /// One line that says where the stream ended early; empty where it did not.
  [[nodiscard]] std::string interruption() const;

 private:
  FrameStream& stream_;
  std::atomic<std::size_t> frames_ = 0;
  std::atomic<bool> ended_early_ = false;
};

}  // namespace stillmap
