// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/object_source.hpp"

#include <utility>

namespace stillmap {

ObjectSource::ObjectSource(const Segmenter* segmenter, const ObjectTrackerConfig& config)
    : segmenter_(segmenter), tracker_(config, FillRule::kBothWays) {}

std::vector<FrameObjects> ObjectSource::push(const RgbdFrame& frame) {
  std::vector<FrameObjects> ready;
  if (segmenter_ == nullptr) {
    ready.push_back({frame.id, frame.stamp, {}, {}});
    return ready;
  }
  FrameDetections detections = segmenter_->segment(frame.color, frame.stamp);
  std::optional<FrameObjects> objects =
      tracker_.push({frame.id, std::move(detections), frame.depth});
  if (objects) ready.push_back(std::move(*objects));
  return ready;
}

std::vector<FrameObjects> ObjectSource::flush() {
  if (segmenter_ == nullptr) return {};
  return tracker_.flush();
}

}  // namespace stillmap
