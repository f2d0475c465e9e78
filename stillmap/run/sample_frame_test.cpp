// SPDX-License-Identifier: Apache-2.0
#include "stillmap/run/sample_frame.hpp"

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
  result.dynamics.dropped = {{{4, 4}, FeatureFate::kDynamic}};
  return result;
}

std::vector<SampleFate> fates_of(const FrameResult& result) {
  std::vector<SampleFate> fates;
  for (const SampleFeature& feature : make_sample({}, result).features) {
    fates.push_back(feature.fate);
  }
  return fates;
}

TEST(MakeSample, SaysOfEachFeatureWhatBecameOfIt) {
  FrameResult result = four_features();
  result.dynamics.fates = {FeatureFate::kStable, FeatureFate::kStaticInBox, FeatureFate::kStable};
  EXPECT_EQ(fates_of(result),
            (std::vector{SampleFate::kTracked,
                         SampleFate::kStaticInBox,
                         SampleFate::kUntracked,
                         SampleFate::kDynamic}));
  result.dynamics.fates = {
      FeatureFate::kMissingDepth, FeatureFate::kUnstableDepth, FeatureFate::kStable};
  EXPECT_EQ(fates_of(result),
            (std::vector{SampleFate::kMissingDepth,
                         SampleFate::kDepthJump,
                         SampleFate::kUntracked,
                         SampleFate::kDynamic}));
}

TEST(MakeSample, WithoutDynamicsKnowsOnlyWhatWasTracked) {
  FrameResult result = four_features();
  result.dynamics.dropped.clear();
  EXPECT_EQ(fates_of(result),
            (std::vector{SampleFate::kTracked, SampleFate::kTracked, SampleFate::kUntracked}));
}

}  // namespace
}  // namespace stillmap
