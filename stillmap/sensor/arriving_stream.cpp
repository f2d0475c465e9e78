// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/arriving_stream.hpp"

#include <exception>
#include <utility>

namespace stillmap {

ArrivingStream::ArrivingStream(FrameStream& stream, Clock& clock, StageProbe probe)
    : stream_(stream), clock_(clock), probe_(std::move(probe)), reader_([this] { read(); }) {}

void ArrivingStream::read() {
  try {
    begin_work(probe_, Stage::kReading);
    while (std::optional<StreamedFrame> frame = stream_.next()) {
      if (!newest_.put({*std::move(frame), clock_.now_s()})) return;
      begin_work(probe_, Stage::kReading);
    }
    newest_.end();
  } catch (...) {  // thrown again by next()
    newest_.end(std::current_exception());
  }
}

std::optional<StreamedFrame> ArrivingStream::next() {
  std::optional<Newest<Arrived>::Taken> taken = newest_.take();
  if (!taken) return std::nullopt;
  arrival_s_ = taken->value.time_s;
  dropped_ += taken->replaced;
  return std::move(taken->value.frame);
}

}  // namespace stillmap
