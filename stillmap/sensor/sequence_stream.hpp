// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/sensor/frame_selection.hpp"
#include "stillmap/sensor/frame_stream.hpp"
#include "stillmap/sensor/image_warnings.hpp"
#include "stillmap/sensor/sequence.hpp"

namespace stillmap {

/// Plays a sequence, or a part of it, as fast as next() is
/// called. The id of a frame is its frame number in the whole sequence.
class SequenceStream : public FrameStream {
 public:
  /// Throws Error for a selection that begins after the last frame. A later end means the last
  /// frame.
  explicit SequenceStream(Sequence sequence, const FrameSelection& selection = {});

  [[nodiscard]] const CameraModel& camera() const override { return sequence_.camera(); }
  [[nodiscard]] std::optional<std::size_t> size() const override;
  [[nodiscard]] std::optional<StreamedFrame> next() override;
  [[nodiscard]] std::vector<std::string> warnings() const override;

 private:
  Sequence sequence_;
  FrameSelection selection_;
  std::size_t end_;
  std::size_t next_;
  ImageWarnings image_warnings_;
};

}  // namespace stillmap
