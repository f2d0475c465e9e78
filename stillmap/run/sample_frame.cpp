// SPDX-License-Identifier: Apache-2.0
#include "stillmap/run/sample_frame.hpp"

#include <string>

namespace stillmap {
namespace {

SampleObject make_sample_object(const TrackedObject& object, const ObjectState& state) {
  const PixelBox& box = state.box;
  return {.track = state.track.value,
          .class_name = object.detection.class_name,
          .reason = std::string(reason_name(state.reason)),
          .dynamic = state.dynamic,
          .filled = state.filled,
          .box_px = Eigen::AlignedBox2d(Eigen::Vector2d(box.x0, box.y0),
                                        Eigen::Vector2d(box.x1, box.y1))};
}

SampleFate sample_fate(FeatureFate fate, bool tracked) {
  switch (fate) {
    case FeatureFate::kMissingDepth:
      return SampleFate::kMissingDepth;
    case FeatureFate::kUnstableDepth:
      return SampleFate::kDepthJump;
    case FeatureFate::kDynamic:
      return SampleFate::kDynamic;
    case FeatureFate::kStaticInBox:
      return SampleFate::kStaticInBox;
    case FeatureFate::kStable:
      break;
  }
  return tracked ? SampleFate::kTracked : SampleFate::kUntracked;
}

}  // namespace

SampleFrame make_sample(const RgbdFrame& frame, const FrameResult& result) {
  SampleFrame sample;
  sample.stamp = frame.stamp;
  sample.image = frame.color;
  const TrackedFrame& tracked = result.tracked;
  const FrameDynamics& dynamics = result.dynamics;
  for (std::size_t i = 0; i < tracked.landmarks.size(); ++i) {
    // Without dynamics no feature is judged.
    const FeatureFate fate = dynamics.fates.empty() ? FeatureFate::kStable : dynamics.fates[i];
    sample.features.push_back(
        {tracked.features->raw_px[i], sample_fate(fate, tracked.landmarks[i].valid())});
  }
  for (const FatedFeature& feature : dynamics.dropped) {
    sample.features.push_back({feature.raw_px, sample_fate(feature.fate, false)});
  }
  for (std::size_t i = 0; i < dynamics.judged.states.size(); ++i) {
    sample.objects.push_back(
        make_sample_object(dynamics.objects.objects[i], dynamics.judged.states[i]));
  }
  sample.raw_mask = dynamics.judged.mask.raw;
  sample.extended_mask = dynamics.judged.mask.extended;
  sample.jumps = dynamics.judged.mask.jumps;
  return sample;
}

}  // namespace stillmap
