// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/sample_frame.hpp"

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

SampleVerdict sample_verdict(FeatureVerdict verdict, bool tracked) {
  switch (verdict) {
    case FeatureVerdict::kMissingDepth:
      return SampleVerdict::kMissingDepth;
    case FeatureVerdict::kUnstableDepth:
      return SampleVerdict::kDepthJump;
    case FeatureVerdict::kDynamic:
      return SampleVerdict::kDynamic;
    case FeatureVerdict::kStaticInBox:
      return SampleVerdict::kStaticInBox;
    case FeatureVerdict::kStable:
      break;
  }
  return tracked ? SampleVerdict::kTracked : SampleVerdict::kUntracked;
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
    const FeatureVerdict verdict =
        dynamics.verdicts.empty() ? FeatureVerdict::kStable : dynamics.verdicts[i];
    sample.features.push_back(
        {tracked.features->raw_px[i], sample_verdict(verdict, tracked.landmarks[i].valid())});
  }
  for (const RejectedFeature& feature : dynamics.dropped) {
    sample.features.push_back({feature.raw_px, sample_verdict(feature.verdict, false)});
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
