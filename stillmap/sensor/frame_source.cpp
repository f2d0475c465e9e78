// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/frame_source.hpp"

#include <utility>

#include "stillmap/core/stopwatch.hpp"
#include "stillmap/io/image_io.hpp"

namespace stillmap {

FrameSource::FrameSource(const TumSequence& sequence, std::vector<FrameId> frames, StageProbe probe)
    : sequence_(sequence), frames_(std::move(frames)), probe_(std::move(probe)) {}

std::optional<SourcedFrame> FrameSource::next() {
  if (next_ == frames_.size()) return std::nullopt;
  begin_work(probe_, Stage::kReading);
  SourcedFrame sourced;
  sourced.id = frames_[next_++];
  Stopwatch reading;
  try {
    sourced.frame = sequence_.read(sourced.id);
  } catch (const DamagedImage& damage) {
    sourced.damage = damage.what();
  }
  sourced.reading_ms = reading.lap_ms();
  return sourced;
}

}  // namespace stillmap
