// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/object_feed.hpp"

#include <chrono>
#include <memory>
#include <utility>

#include "stillmap/core/error.hpp"

namespace stillmap {

void NetworkFeed::look_at(const FramePtr& frame) {
  const auto task = std::make_shared<std::packaged_task<FrameDetections()>>(
      [frame, this] { return segmenter_.segment(frame->color, frame->stamp); });
  look_ = Look{frame, task->get_future()};
  last_ = frame->id;
  worker_.post([task] { (*task)(); });
}

std::pair<FramePtr, FrameDetections> NetworkFeed::finish_look() {
  Look look = std::move(*look_);
  look_.reset();  // before get(), which may throw
  return {std::move(look.frame), look.detections.get()};
}

ObjectFeedStep NetworkFeed::step(const FramePtr& frame, const LookRequest& request) {
  ObjectFeedStep step;
  const auto is_ready = [&] {
    return look_->detections.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  };
  if (look_ && (request.needs_own || is_ready())) step.arrived.push_back(finish_look());
  if (request.needs_own) {
    look_at(frame);
    step.arrived.push_back(finish_look());
    return step;
  }
  const auto gap = static_cast<std::uint32_t>(request.gap_frames);
  if (!look_ && (!last_ || frame->id.value >= last_->value + gap)) {
    look_at(frame);
    step.looking = true;
  }
  return step;
}

RecordedFeed::RecordedFeed(const Segmenter& segmenter, LiveRecord record)
    : segmenter_(segmenter), record_(std::move(record)) {
  for (const LiveStep& step : record_) {
    looked_at_.insert(step.objects_of.begin(), step.objects_of.end());
  }
}

ObjectFeedStep RecordedFeed::step(const FramePtr& frame, const LookRequest& request) {
  STILLMAP_CHECK(next_ < record_.size() && record_[next_].frame == frame->id);
  const LiveStep& recorded = record_[next_++];
  ObjectFeedStep step;
  step.looking = looked_at_.contains(frame->id);
  if (step.looking) held_[frame->id] = frame;
  for (const FrameId id : recorded.objects_of) {
    const FramePtr looked_at = held_.extract(id).mapped();
    step.arrived.emplace_back(looked_at, segmenter_.segment(looked_at->color, looked_at->stamp));
    if (id == frame->id) step.looking = false;
  }
  const bool has_own = !step.arrived.empty() && step.arrived.back().first->id == frame->id;
  if (request.needs_own && !has_own) {
    throw Error(
        "the record has no objects of frame {}, which a map may begin with: it is of a run with "
        "other settings",
        frame->id.value);
  }
  return step;
}

}  // namespace stillmap
