// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/frame_preparation.hpp"

#include <utility>

#include "stillmap/core/stopwatch.hpp"

namespace stillmap {

FramePreparation::FramePreparation(FrameSource source,
                                   ObjectSource objects,
                                   const System& system,
                                   bool ahead)
    : source_(std::move(source)),
      objects_(std::move(objects)),
      system_(system),
      read_([this] { return source_.next(); }, ahead ? kAhead : 0),
      prepared_([this] { return prepare(); }, ahead ? kAhead : 0) {}

std::optional<PreparedFrames> FramePreparation::prepare() {
  if (ended_) return std::nullopt;
  PreparedFrames prepared;
  std::optional<SourcedFrame> read = read_.next();
  if (!read) {
    ended_ = true;
    prepared.at_end = true;
    prepared.ready = prepare(objects_.flush());
    return prepared;
  }
  Stopwatch segmentation;
  const FramePtr frame = std::exchange(read->frame, nullptr);
  prepared.source = std::move(*read);
  if (frame == nullptr) return prepared;
  std::vector<FrameWithObjects> with_objects = objects_.push(frame);
  if (objects_.looks()) prepared.segmentation_ms = segmentation.lap_ms();
  prepared.ready = prepare(std::move(with_objects));
  return prepared;
}

std::vector<PreparedFrame> FramePreparation::prepare(std::vector<FrameWithObjects> frames) const {
  std::vector<PreparedFrame> ready;
  for (FrameWithObjects& frame : frames) {
    ready.push_back(system_.prepare(std::move(frame.frame), std::move(frame.objects)));
  }
  return ready;
}

}  // namespace stillmap
