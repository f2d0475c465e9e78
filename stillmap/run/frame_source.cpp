// SPDX-License-Identifier: Apache-2.0
#include "stillmap/run/frame_source.hpp"

#include "stillmap/io/image_io.hpp"

namespace stillmap {

FrameSource::FrameSource(const TumSequence& sequence, std::vector<FrameId> frames, bool read_ahead)
    : sequence_(sequence), frames_(std::move(frames)) {
  if (read_ahead) reader_ = std::jthread([this] { run(); });
}

FrameSource::~FrameSource() {
  channel_.cancel();
}

std::optional<SourcedFrame> FrameSource::next() {
  if (reader_.joinable()) return channel_.pop();
  if (next_ == frames_.size()) return std::nullopt;
  return read(frames_[next_++]);
}

SourcedFrame FrameSource::read(FrameId id) const {
  try {
    return {id, sequence_.read(id), {}};
  } catch (const DamagedImage& damage) {
    return {id, nullptr, damage.what()};
  }
}

void FrameSource::run() {
  try {
    for (const FrameId id : frames_) {
      if (!channel_.push(read(id))) return;
    }
    channel_.close();
  } catch (...) {  // the consumer's pop() throws it
    channel_.fail(std::current_exception());
  }
}

}  // namespace stillmap
