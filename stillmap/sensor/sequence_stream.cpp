// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/sequence_stream.hpp"

#include <algorithm>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"

namespace stillmap {

SequenceStream::SequenceStream(Sequence sequence, const FrameSelection& selection)
    : sequence_(std::move(sequence)),
      selection_(selection),
      end_(std::min(selection.end.value_or(sequence_.size()), sequence_.size())),
      next_(selection.begin) {
  STILLMAP_CHECK(selection.stride > 0);
  if (selection.begin >= end_) {
    throw Error("the frames asked for begin at {}, but {} has only {} frames",
                selection.begin,
                sequence_.path().string(),
                sequence_.size());
  }
}

std::optional<std::size_t> SequenceStream::size() const {
  return (end_ - selection_.begin + selection_.stride - 1) / selection_.stride;
}

std::optional<StreamedFrame> SequenceStream::next() {
  if (next_ >= end_) return std::nullopt;
  const FrameId id(static_cast<std::uint32_t>(next_));
  next_ += selection_.stride;
  try {
    FrameReading reading = sequence_.read_with_warning(id);
    image_warnings_.add(reading.warning);
    return std::move(reading.frame);
  } catch (const DamagedImage& damage) {
    return DamagedFrame{id, sequence_.entry(id).stamp, damage.what()};
  }
}

std::vector<std::string> SequenceStream::warnings() const {
  return image_warnings_.lines();
}

}  // namespace stillmap
