// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/sensor/frame_reader.hpp"
#include "stillmap/sensor/frame_selection.hpp"
#include "stillmap/sensor/frame_stream.hpp"

namespace stillmap {

/// Plays a sequence, or a part of it, as fast as next() is called, as seen by a camera that may
/// have a depth camera of its own. The id of a frame is its frame number in the whole sequence.
class SequenceFrames : public FrameStream {
 public:
  /// `camera` in place of the sequence's. Throws Error for a selection that begins after the last
  /// frame. A later end means the last frame.
  SequenceFrames(TumSequence sequence,
                 const CameraModel& camera,
                 const FrameSelection& selection = {});

  [[nodiscard]] const CameraModel& camera() const override { return reader_.camera(); }
  [[nodiscard]] std::optional<std::size_t> size() const override;
  [[nodiscard]] std::optional<StreamedFrame> next() override;

 private:
  TumSequence sequence_;
  FrameReader reader_;
  FrameSelection selection_;
  std::size_t end_;
  std::size_t next_;
};

}  // namespace stillmap
