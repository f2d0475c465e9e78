// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/frame_preparation.hpp"

#include "stillmap/core/error.hpp"
#include "stillmap/core/stopwatch.hpp"

namespace stillmap {

FramePreparation::FramePreparation(FrameStream& stream,
                                   ObjectSource objects,
                                   const System& system,
                                   bool ahead,
                                   const StageProbe& probe)
    : stream_(stream),
      objects_(std::move(objects)),
      system_(system),
      probe_(probe),
      read_([this] { return read(); }, ahead ? kAhead : 0),
      prepared_([this] { return prepare(); }, ahead ? kAhead : 0) {}

std::optional<FramePreparation::TimedFrame> FramePreparation::read() {
  begin_work(probe_, Stage::kReading);
  Stopwatch reading;
  std::optional<StreamedFrame> frame = stream_.next();
  if (!frame) return std::nullopt;
  return TimedFrame{std::move(*frame), reading.lap_ms()};
}

std::optional<FramePreparation::Step> FramePreparation::prepare() {
  if (ended_) return std::nullopt;
  Step step;
  std::optional<TimedFrame> read = read_.next();
  if (!read) {
    ended_ = true;
    step.ready = prepare(objects_.flush());
    STILLMAP_CHECK(waiting_.empty());
    return step;
  }
  step.times.push_back({"reading", read->second});
  if (DamagedFrame* const damaged = std::get_if<DamagedFrame>(&read->first)) {
    step.damaged = std::move(*damaged);
    return step;
  }
  Stopwatch segmentation;
  const FramePtr frame = std::get<FramePtr>(std::move(read->first));
  waiting_.push_back(frame);
  std::vector<FrameObjects> objects = objects_.push(*frame);
  if (objects_.has_network()) step.times.push_back({"segmentation", segmentation.lap_ms()});
  step.ready = prepare(std::move(objects));
  return step;
}

std::vector<PreparedFrame> FramePreparation::prepare(std::vector<FrameObjects> objects) {
  std::vector<PreparedFrame> ready;
  for (FrameObjects& own : objects) {
    STILLMAP_CHECK(!waiting_.empty() && waiting_.front()->id == own.frame);
    ready.push_back(system_.prepare(std::move(waiting_.front()), std::move(own)));
    waiting_.pop_front();
  }
  return ready;
}

}  // namespace stillmap
