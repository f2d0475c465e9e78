// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/object_finder.hpp"

#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"

namespace stillmap {

struct ObjectFinder::State {
  std::shared_ptr<const Segmenter> network;
  ObjectTracker tracker{{}, FillRule::kCausal};
  std::uint32_t frames = 0;
};

ObjectFinder::ObjectFinder(std::shared_ptr<const Segmenter> network)
    : state_(std::make_unique<State>()) {
  if (network == nullptr) throw Error("an object finder needs a network");
  state_->network = std::move(network);
}
ObjectFinder::ObjectFinder(ObjectFinder&&) noexcept = default;
ObjectFinder& ObjectFinder::operator=(ObjectFinder&&) noexcept = default;
ObjectFinder::~ObjectFinder() = default;

FrameObjects ObjectFinder::find(const RgbdFrame& frame) {
  const FrameId id = frame.id.valid() ? frame.id : FrameId(state_->frames);
  ++state_->frames;
  std::optional<FrameObjects> objects =
      state_->tracker.push({id, state_->network->segment(frame.color, frame.stamp), frame.depth});
  STILLMAP_CHECK(objects.has_value());  // a causal tracker gives each frame at once
  return *std::move(objects);
}

}  // namespace stillmap
