// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/sequence_frames.hpp"

#include <algorithm>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"

namespace stillmap {

SequenceFrames::SequenceFrames(TumSequence sequence,
                               const CameraModel& camera,
                               const FrameSelection& selection)
    : sequence_(std::move(sequence)),
      reader_(camera),
      selection_(selection),
      end_(std::min(selection.end.value_or(sequence_.size()), sequence_.size())),
      next_(selection.begin) {
  STILLMAP_CHECK(selection.stride > 0);
  if (selection.begin >= end_) {
    throw Error("the frames asked for begin at {}, but {} has only {} frames",
                selection.begin,
                sequence_.folder().string(),
                sequence_.size());
  }
}

std::optional<std::size_t> SequenceFrames::size() const {
  return (end_ - selection_.begin + selection_.stride - 1) / selection_.stride;
}

std::optional<StreamedFrame> SequenceFrames::next() {
  if (next_ >= end_) return std::nullopt;
  const FrameId id(static_cast<std::uint32_t>(next_));
  next_ += selection_.stride;
  const SequenceEntry& files = sequence_.entry(id);
  try {
    return reader_.read(files, id);
  } catch (const DamagedImage& damage) {
    return DamagedFrame{id, files.stamp, damage.what()};
  }
}

}  // namespace stillmap
