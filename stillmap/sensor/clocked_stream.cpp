// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/clocked_stream.hpp"

#include <utility>

namespace stillmap {

ClockedStream::ClockedStream(FrameStream& stream, double speed, Clock& clock, StageProbe probe)
    : stream_(stream),
      speed_(speed),
      clock_(clock),
      probe_(std::move(probe)),
      read_(
          [this] {
            begin_work(probe_, Stage::kReading);
            return stream_.next();
          },
          kAhead) {}

void ClockedStream::read_one() {
  coming_ = read_.next();
  if (!coming_) return;
  const double stamp_s = stamp_of(*coming_).seconds;
  if (!begin_s_) {
    begin_s_ = clock_.now_s();
    first_stamp_s_ = last_stamp_s_ = stamp_s;
  }
  const double pause_s = stamp_s - std::exchange(last_stamp_s_, stamp_s);
  if (pause_s > kLongestPauseS) {
    first_stamp_s_ += pause_s - kCutPauseS;
    skipped_s_ += pause_s - kCutPauseS;
  }
  coming_arrival_s_ = *begin_s_ + (stamp_s - first_stamp_s_) / speed_;
}

void ClockedStream::take(std::optional<StreamedFrame>& frame) {
  frame = std::exchange(coming_, std::nullopt);
  arrival_s_ = coming_arrival_s_;
}

std::optional<StreamedFrame> ClockedStream::next() {
  if (!coming_) read_one();
  if (!coming_) return std::nullopt;
  clock_.wait_until_s(coming_arrival_s_);
  std::optional<StreamedFrame> newest;
  take(newest);
  for (read_one(); coming_ && coming_arrival_s_ <= clock_.now_s(); read_one()) {
    take(newest);
    ++dropped_;
  }
  return newest;
}

}  // namespace stillmap
