// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/sample_frame.hpp"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

// Three features were used, the first two of them seen as landmarks; a fourth was dropped.
FrameResult four_features() {
  FrameResult result;
  Features features;
  features.raw_px = {{1, 1}, {2, 2}, {3, 3}};
  result.tracked.features = std::make_shared<const Features>(features);
  result.tracked.landmarks = {LandmarkId(7), LandmarkId(8), LandmarkId()};
  result.dynamics.dropped = {{{4, 4}, FeatureVerdict::kDynamic}};
  return result;
}

std::vector<SampleVerdict> fates_of(const FrameResult& result) {
  std::vector<SampleVerdict> verdicts;
  for (const SampleFeature& feature : make_sample({}, result).features) {
    verdicts.push_back(feature.verdict);
  }
  return verdicts;
}

TEST(MakeSample, SaysOfEachFeatureWhatBecameOfIt) {
  FrameResult result = four_features();
  result.dynamics.verdicts = {
      FeatureVerdict::kStable, FeatureVerdict::kStaticInBox, FeatureVerdict::kStable};
  EXPECT_EQ(fates_of(result),
            (std::vector{SampleVerdict::kTracked,
                         SampleVerdict::kStaticInBox,
                         SampleVerdict::kUntracked,
                         SampleVerdict::kDynamic}));
  result.dynamics.verdicts = {
      FeatureVerdict::kMissingDepth, FeatureVerdict::kUnstableDepth, FeatureVerdict::kStable};
  EXPECT_EQ(fates_of(result),
            (std::vector{SampleVerdict::kMissingDepth,
                         SampleVerdict::kDepthJump,
                         SampleVerdict::kUntracked,
                         SampleVerdict::kDynamic}));
}

TEST(MakeSample, WithoutDynamicsKnowsOnlyWhatWasTracked) {
  FrameResult result = four_features();
  result.dynamics.dropped.clear();
  EXPECT_EQ(
      fates_of(result),
      (std::vector{SampleVerdict::kTracked, SampleVerdict::kTracked, SampleVerdict::kUntracked}));
}

}  // namespace
}  // namespace stillmap
