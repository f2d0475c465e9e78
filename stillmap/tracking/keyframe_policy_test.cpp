// SPDX-License-Identifier: Apache-2.0
#include "stillmap/tracking/keyframe_policy.hpp"

#include <gtest/gtest.h>

namespace stillmap {
namespace {

constexpr std::uint32_t kFeatures = 400;

FeaturesPtr features_at(float depth_m) {
  Features features;
  features.px.assign(kFeatures, Eigen::Vector2f(1, 1));
  features.depth_m.assign(kFeatures, depth_m);
  features.level.assign(kFeatures, 0);
  features.descriptors.assign(kFeatures, Descriptor{});
  return std::make_shared<const Features>(std::move(features));
}

// `keyframes` key frames; the first `established` features of all see the same landmarks, the
// others of the first see landmarks that nobody else does.
Map map_with(int keyframes, std::uint32_t established) {
  Map map({1.0F});
  for (int k = 0; k < keyframes; ++k) {
    Keyframe keyframe;
    keyframe.features = features_at(2);
    const KeyframeId id = map.add_keyframe(keyframe);
    for (std::uint32_t i = 0; i < (k == 0 ? kFeatures : established); ++i) {
      if (k == 0) map.add_landmark({0, 0, 2}, {id, i});
      if (k > 0) map.add_observation(LandmarkId(i), {id, i});
    }
  }
  return map;
}

// A frame that tracks `tracked` landmarks, all features at `depth_m`.
TrackedFrame frame_with(std::uint32_t tracked, float depth_m = 2) {
  TrackedFrame frame;
  frame.status = TrackingStatus::kTracked;
  frame.reference = KeyframeId(0);
  frame.features = features_at(depth_m);
  frame.landmarks.assign(kFeatures, LandmarkId{});
  for (std::uint32_t i = 0; i < tracked; ++i) frame.landmarks[i] = LandmarkId(i);
  frame.inliers = static_cast<int>(tracked);
  return frame;
}

bool wants(const TrackedFrame& frame, int gap, const Map& map) {
  return wants_keyframe({}, frame, gap, map);
}

TEST(WantsKeyframe, NeverTooSoonAndAlwaysAfterTheLongestGap) {
  const Map map = map_with(4, 200);
  EXPECT_FALSE(wants(frame_with(0), 3, map));
  EXPECT_TRUE(wants(frame_with(0), 4, map));
  EXPECT_FALSE(wants(frame_with(380), 29, map));
  EXPECT_TRUE(wants(frame_with(380), 30, map));
}

TEST(WantsKeyframe, NeverOfALostFrame) {
  TrackedFrame lost = frame_with(0);
  lost.status = TrackingStatus::kLost;
  EXPECT_FALSE(wants(lost, 1000, map_with(4, 200)));
}

TEST(WantsKeyframe, WhenTooFewOfTheReferencesEstablishedLandmarksAreFound) {
  const Map map = map_with(4, 200);  // needs 150; near landmarks suffice
  EXPECT_TRUE(wants(frame_with(149), 10, map));
  EXPECT_FALSE(wants(frame_with(150), 10, map));
}

TEST(WantsKeyframe, CountsLandmarksThatThreeSeeOrTwoInAYoungMap) {
  EXPECT_FALSE(wants(frame_with(150), 10, map_with(2, 200)));
  EXPECT_TRUE(wants(frame_with(149), 10, map_with(2, 200)));
  EXPECT_TRUE(wants(frame_with(149), 10, map_with(3, 200)));
  // Two see 200 landmarks, but there are three key frames: none counts.
  Map map = map_with(2, 200);
  Keyframe third;
  third.features = features_at(2);
  map.add_keyframe(third);
  EXPECT_FALSE(wants(frame_with(149), 10, map));
}

TEST(WantsKeyframe, WhenManyNearFeaturesCouldBecomeLandmarks) {
  const Map map = map_with(4, 100);  // ratio asks for 75
  EXPECT_TRUE(wants(frame_with(99), 10, map));
  EXPECT_FALSE(wants(frame_with(100), 10, map));
  EXPECT_FALSE(wants(frame_with(99, 3.1F), 10, map));  // far
  EXPECT_FALSE(wants(frame_with(99, 0), 10, map));     // no depth
  TrackedFrame few_left = frame_with(99);
  Features features = *few_left.features;
  for (std::uint32_t i = 99 + 69; i < kFeatures; ++i) features.depth_m[i] = 0;
  few_left.features = std::make_shared<const Features>(std::move(features));
  EXPECT_FALSE(wants(few_left, 10, map));
}

TEST(WantsKeyframe, AsksTheAnchorOfADroppedReference) {
  Map map = map_with(5, 200);
  TrackedFrame frame = frame_with(149);
  frame.reference = KeyframeId(4);
  EXPECT_TRUE(wants(frame, 10, map));
  map.remove_keyframe(KeyframeId(4), KeyframeId(3));
  EXPECT_TRUE(wants(frame, 10, map));
}

}  // namespace
}  // namespace stillmap
