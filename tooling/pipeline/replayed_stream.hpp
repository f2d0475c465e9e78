// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "stillmap/sensor/frame_stream.hpp"
#include "tooling/pipeline/live_record.hpp"

namespace stillmap {

/// Plays those frames of another stream that a live run has processed, according to its record. All
/// other frames are dropped.
class ReplayedStream : public FrameStream {
 public:
  /// Stream and record outlive the object. `name` is the record's file, for messages.
  ReplayedStream(FrameStream& stream, const LiveRecord& record, std::string name)
      : stream_(stream), record_(record), name_(std::move(name)) {}

  [[nodiscard]] const CameraModel& camera() const override { return stream_.camera(); }
  [[nodiscard]] std::optional<std::size_t> size() const override { return record_.size(); }

  /// The next frame of the record, never a damaged one. Throws Error for a frame of the record that
  /// the stream lacks, has with another stamp, or has damaged.
  [[nodiscard]] std::optional<StreamedFrame> next() override;

  /// The number of frames dropped before the one that next() returned last.
  [[nodiscard]] std::size_t dropped() const { return dropped_; }

 private:
  FrameStream& stream_;
  const LiveRecord& record_;
  std::string name_;
  std::size_t next_ = 0;
  std::size_t dropped_ = 0;
};

}  // namespace stillmap
