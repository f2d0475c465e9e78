// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/live_camera.hpp"

namespace stillmap {

LiveCamera::LiveCamera(FrameSource source, const TumSequence& sequence, double speed, Clock& clock)
    : sequence_(sequence),
      speed_(speed),
      clock_(clock),
      source_(std::move(source)),
      read_([this] { return source_.next(); }, kAhead) {}

void LiveCamera::read_one() {
  std::optional<SourcedFrame> read = read_.next();
  if (!read) return;
  const double stamp_s = sequence_.entry(read->id).stamp.seconds;
  if (!begin_s_) {
    begin_s_ = clock_.now_s();
    first_stamp_s_ = stamp_s;
  }
  coming_ = CapturedFrame{std::move(*read), *begin_s_ + (stamp_s - first_stamp_s_) / speed_};
}

std::optional<CapturedFrame> LiveCamera::next() {
  if (!coming_) read_one();
  if (!coming_) return std::nullopt;
  clock_.wait_until_s(coming_->arrival_s);
  std::optional<CapturedFrame> newest = std::exchange(coming_, std::nullopt);
  for (read_one(); coming_ && coming_->arrival_s <= clock_.now_s(); read_one()) {
    newest = std::exchange(coming_, std::nullopt);
    ++dropped_;
  }
  return newest;
}

}  // namespace stillmap
