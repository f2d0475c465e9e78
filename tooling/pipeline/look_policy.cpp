// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/look_policy.hpp"

#include <algorithm>

#include <opencv2/core.hpp>

namespace stillmap {
namespace {

constexpr double kHardlyAny = 0.002;  // share of the image: noise at edges
constexpr double kMany = 0.005;       // a forearm at 2 m
constexpr double kNew = 1.5;          // factor on the mean of the last frames
constexpr double kMeanGain = 0.2;

double share_of(const Mask& mask) {
  if (mask.empty()) return 0;
  return static_cast<double>(cv::countNonZero(mask.mat)) / static_cast<double>(mask.mat.total());
}

}  // namespace

void LookPolicy::observe(const FrameResult& result) {
  const double jumped = share_of(result.depth_jumps);
  const bool came = jumped > kMany && jumped > kNew * jumped_;
  jumped_ += kMeanGain * (jumped - jumped_);
  bool any_dynamic = false, first_seen = false;
  for (const ObjectState& object : result.objects) {
    if (!object.dynamic) continue;
    any_dynamic = true;
    first_seen = known_.insert(object.track).second || first_seen;
  }
  if (came || first_seen) {
    gap_frames_ = 1;
  } else if (finds_jumps_ && !any_dynamic && jumped <= kHardlyAny) {
    gap_frames_ = std::max(config_.look_rest_frames, config_.look_gap_frames);
  } else {
    gap_frames_ = config_.look_gap_frames;
  }
}

}  // namespace stillmap
