// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/tracking/keyframe_policy.hpp"

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

/// One whose landmarks `known` (ids from 0) are seen by as many key frames as count as well known,
/// the others by one fewer.
Map map_with(std::uint32_t known) {
  const auto observers = static_cast<std::uint32_t>(KeyframePolicyConfig{}.known_observers);
  Map map({1.0F});
  for (std::uint32_t k = 0; k < observers; ++k) {
    Keyframe keyframe;
    keyframe.features = features_at(2);
    map.add_keyframe(std::move(keyframe));
  }
  for (std::uint32_t i = 0; i < kFeatures; ++i) {
    const LandmarkId id = map.add_landmark({0, 0, 2}, {KeyframeId(0), i});
    const std::uint32_t seen_by = i < known ? observers : observers - 1;
    for (std::uint32_t k = 1; k < seen_by; ++k) map.add_observation(id, {KeyframeId(k), i});
  }
  return map;
}

bool wants(const TrackedFrame& frame, int frames, int most_inliers, const Map& map = map_with(0)) {
  return wants_keyframe({}, frame, {.frames = frames, .most_inliers = most_inliers}, map);
}

TEST(WantsKeyframe, NeverTooSoonAndAlwaysAfterTheLongestGap) {
  EXPECT_FALSE(wants(frame_with(0), 5, 200));
  EXPECT_TRUE(wants(frame_with(0), 6, 200));
  EXPECT_FALSE(wants(frame_with(380), 29, 380));
  EXPECT_TRUE(wants(frame_with(380), 30, 380));
}

TEST(WantsKeyframe, NeverOfALostFrame) {
  TrackedFrame lost = frame_with(0);
  lost.status = TrackingStatus::kLost;
  EXPECT_FALSE(wants(lost, 1000, 200));
}

TEST(WantsKeyframe, NeverOfTheFrameThatIsFoundAgain) {
  TrackedFrame found = frame_with(0);
  EXPECT_TRUE(wants(found, 1000, 200));
  found.status = TrackingStatus::kRelocalized;
  EXPECT_FALSE(wants(found, 1000, 200));
}

TEST(WantsKeyframe, WhenFewerLandmarksAreFoundThanSinceTheLastOne) {
  EXPECT_TRUE(wants(frame_with(149), 10, 200));  // 75 % of 200 are 150
  EXPECT_FALSE(wants(frame_with(150), 10, 200));
}

TEST(WantsKeyframe, InAKnownPlaceOnlyWhenFarFewerAreFound) {
  const Map known = map_with(kFeatures);
  const auto far = [](std::uint32_t tracked) { return frame_with(tracked, 5); };
  EXPECT_TRUE(wants(far(149), 10, 200));
  EXPECT_FALSE(wants(far(149), 10, 200, known));
  EXPECT_FALSE(wants(far(100), 10, 200, known));
  EXPECT_TRUE(wants(far(99), 10, 200, known));  // half of them
  EXPECT_TRUE(wants(far(380), 30, 380));
  EXPECT_FALSE(wants(far(380), 3000, 380, known));
  EXPECT_TRUE(wants(frame_with(99), 10, 100, known));  // near landmarks run short
}

TEST(WantsKeyframe, KnownIsWhereEnoughLandmarksAreSeenByEnough) {
  const TrackedFrame frame = frame_with(100, 5);  // of up to 200: the share would be below 75 %
  EXPECT_TRUE(wants(frame, 10, 200, map_with(60)));
  EXPECT_FALSE(wants(frame, 10, 200, map_with(61)));
  KeyframePolicyConfig config;
  config.max_known_share = 1;  // the rule is off
  EXPECT_TRUE(
      wants_keyframe(config, frame, {.frames = 10, .most_inliers = 200}, map_with(kFeatures)));
}

TEST(WantsKeyframe, WhenManyNearFeaturesCouldBecomeLandmarks) {
  EXPECT_TRUE(wants(frame_with(99), 10, 100));
  EXPECT_FALSE(wants(frame_with(100), 10, 100));
  EXPECT_FALSE(wants(frame_with(99, 3.1F), 10, 100));  // far
  EXPECT_FALSE(wants(frame_with(99, 0), 10, 100));     // no depth
  TrackedFrame few_left = frame_with(99);
  Features features = *few_left.features;
  for (std::uint32_t i = 99 + 69; i < kFeatures; ++i) features.depth_m[i] = 0;
  few_left.features = std::make_shared<const Features>(std::move(features));
  EXPECT_FALSE(wants(few_left, 10, 100));
}

}  // namespace
}  // namespace stillmap
