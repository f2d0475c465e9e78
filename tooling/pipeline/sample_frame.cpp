// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/sample_frame.hpp"

#include <string>

namespace stillmap {
namespace {

SampleObject make_sample_object(const ObjectState& state) {
  const PixelBox& box = state.box;
  return {.track = state.track.value,
          .class_name = state.class_name,
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
  for (const FeatureMark& feature : result.features) {
    sample.features.push_back({feature.raw_px, sample_verdict(feature.verdict, feature.tracked)});
  }
  for (const ObjectState& state : result.objects) {
    sample.objects.push_back(make_sample_object(state));
  }
  sample.raw_mask = result.network_mask.mat;
  sample.extended_mask = result.extended_mask.mat;
  sample.jumps = result.depth_jumps.mat;
  return sample;
}

}  // namespace stillmap
