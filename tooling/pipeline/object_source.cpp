// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/object_source.hpp"

#include <utility>

#include "stillmap/core/error.hpp"

namespace stillmap {

ObjectSource::ObjectSource(const Segmenter* segmenter, const ObjectTrackerConfig& config)
    : segmenter_(segmenter), tracker_(config, FillRule::kBothWays) {}

std::vector<FrameWithObjects> ObjectSource::push(FramePtr frame) {
  std::vector<FrameWithObjects> ready;
  if (segmenter_ == nullptr) {
    ready.push_back({std::move(frame), {}});
    return ready;
  }
  FrameDetections detections = segmenter_->segment(frame->color, frame->stamp);
  ObservedFrame observed{frame->id, std::move(detections), frame->depth};
  waiting_.push_back(std::move(frame));
  if (std::optional<FrameObjects> objects = tracker_.push(std::move(observed))) {
    ready.push_back(pair_up(std::move(*objects)));
  }
  return ready;
}

std::vector<FrameWithObjects> ObjectSource::flush() {
  std::vector<FrameWithObjects> rest;
  if (segmenter_ == nullptr) return rest;
  for (FrameObjects& objects : tracker_.flush()) rest.push_back(pair_up(std::move(objects)));
  STILLMAP_CHECK(waiting_.empty());
  return rest;
}

FrameWithObjects ObjectSource::pair_up(FrameObjects objects) {
  FrameWithObjects pair{std::move(waiting_.front()), std::move(objects)};
  waiting_.pop_front();
  STILLMAP_CHECK(pair.frame->id == pair.objects.frame);
  return pair;
}

}  // namespace stillmap
