// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/mapping/culling.hpp"

#include <gtest/gtest.h>

#include "stillmap/slam/map/covisibility.hpp"

namespace stillmap {
namespace {

constexpr std::uint32_t kFeatures = 20;

MeasurementModel model() {
  return MeasurementModel({}, {1, 1, 1, 1});
}

KeyframeId kf(std::uint32_t value) {
  return KeyframeId(value);
}

// Adds a key frame at x = its number, with all features on `level`.
KeyframeId add_keyframe(Map& map, std::uint8_t level = 1, float depth_m = 2) {
  Features features;
  features.px.assign(kFeatures, Eigen::Vector2f(1, 1));
  features.depth_m.assign(kFeatures, depth_m);
  features.level.assign(kFeatures, level);
  features.descriptors.assign(kFeatures, Descriptor{});
  Keyframe keyframe;
  keyframe.features = std::make_shared<const Features>(std::move(features));
  keyframe.T_world_camera.translation().x() = static_cast<double>(map.keyframes().size());
  return map.add_keyframe(std::move(keyframe));
}

Map empty_keyframes(int count) {
  Map map({1, 1, 1, 1});
  for (int k = 0; k < count; ++k) add_keyframe(map);
  return map;
}

// Landmark i is seen by feature i of the first `seen` features of all key frames.
void see_the_same(Map& map, std::uint32_t seen) {
  for (std::uint32_t i = 0; i < seen; ++i) {
    const LandmarkId id = map.add_landmark({0, 0, 2}, {kf(0), i});
    for (const auto& [keyframe, unused] : map.keyframes()) {
      if (keyframe != kf(0)) map.add_observation(id, {keyframe, i});
    }
  }
}

void count(Map& map, LandmarkId id, int expected, int found) {
  for (int i = 1; i < expected; ++i) map.count_expected(id);  // a landmark begins with 1
  for (int i = 1; i < found; ++i) map.count_found(id);
}

TEST(CullYoungLandmarks, RemovesWhatTrackingRarelyFinds) {
  Map map = empty_keyframes(2);
  const LandmarkId rare = map.add_landmark({0, 0, 2}, {kf(1), 0});
  const LandmarkId just = map.add_landmark({0, 0, 2}, {kf(1), 1});
  count(map, rare, 41, 10);
  count(map, just, 40, 10);
  EXPECT_EQ(cull_young_landmarks(map, kf(1), {}), 1);
  EXPECT_EQ(map.find(rare), nullptr);
  EXPECT_NE(map.find(just), nullptr);
}

TEST(CullYoungLandmarks, RemovesWhatOneKeyframeAloneSeesAfterTwo) {
  Map map = empty_keyframes(4);
  const LandmarkId lonely = map.add_landmark({0, 0, 2}, {kf(1), 0});
  const LandmarkId young = map.add_landmark({0, 0, 2}, {kf(2), 1});
  const LandmarkId seen_twice = map.add_landmark({0, 0, 2}, {kf(1), 2});
  map.add_observation(seen_twice, {kf(2), 2});
  EXPECT_EQ(cull_young_landmarks(map, kf(3), {}), 1);
  EXPECT_EQ(map.find(lonely), nullptr);
  EXPECT_NE(map.find(young), nullptr);
  EXPECT_NE(map.find(seen_twice), nullptr);
}

TEST(CullYoungLandmarks, LeavesThoseThatPassedTheirProbation) {
  Map map = empty_keyframes(6);
  const LandmarkId old = map.add_landmark({0, 0, 2}, {kf(1), 0});
  const LandmarkId last_chance = map.add_landmark({0, 0, 2}, {kf(2), 0});
  count(map, old, 100, 1);
  count(map, last_chance, 100, 1);
  EXPECT_EQ(cull_young_landmarks(map, kf(5), {}), 1);
  EXPECT_NE(map.find(old), nullptr);
  EXPECT_EQ(map.find(last_chance), nullptr);
}

std::vector<KeyframeId> all_of(const Map& map) {
  std::vector<KeyframeId> ids;
  for (const auto& [id, keyframe] : map.keyframes()) ids.push_back(id);
  return ids;
}

TEST(CullRedundantKeyframes, DropsThoseThatThreeOthersRepeat) {
  Map map = empty_keyframes(5);
  see_the_same(map, kFeatures);
  // Of five any of 1 to 3 is seen by four others; after one has gone the next by three; then two.
  EXPECT_EQ(cull_redundant_keyframes(map, all_of(map), kf(4), model(), {}), 2);
  EXPECT_EQ(all_of(map), (std::vector{kf(0), kf(3), kf(4)}));
  EXPECT_EQ(map.landmark_count(), kFeatures);
  EXPECT_DOUBLE_EQ(map.T_world_keyframe(kf(1)).translation().x(), 1.0);
  EXPECT_DOUBLE_EQ(map.T_world_keyframe(kf(2)).translation().x(), 2.0);
  map.check_consistency();
}

TEST(CullRedundantKeyframes, DropsOnlyCandidatesNeverTheFirstOrNewest) {
  Map map = empty_keyframes(8);
  see_the_same(map, kFeatures);
  EXPECT_EQ(cull_redundant_keyframes(map, std::vector{kf(0), kf(7)}, kf(7), model(), {}), 0);
  EXPECT_EQ(cull_redundant_keyframes(map, std::vector{kf(5)}, kf(7), model(), {}), 1);
  EXPECT_FALSE(map.has(kf(5)));
}

TEST(CullRedundantKeyframes, AsksForMoreThanNineTenthsOfItsLandmarks) {
  for (const auto& [lost, dropped] : {std::pair(2U, 0), std::pair(1U, 1)}) {
    Map map = empty_keyframes(5);
    see_the_same(map, kFeatures);  // 20: 18 are not more than nine tenths, 19 are
    for (std::uint32_t i = 0; i < lost; ++i) {
      for (const std::uint32_t other : {0U, 3U}) map.remove_observation(LandmarkId(i), kf(other));
    }
    EXPECT_EQ(cull_redundant_keyframes(map, std::vector{kf(2)}, kf(4), model(), {}), dropped);
  }
}

TEST(CullRedundantKeyframes, CountsOnlyObserversAsFine) {
  for (const auto& [level, dropped] : {std::pair(2, 1), std::pair(3, 0)}) {
    Map map({1, 1, 1, 1});
    add_keyframe(map, static_cast<std::uint8_t>(level));
    for (int k = 1; k < 4; ++k) add_keyframe(map);
    see_the_same(map, kFeatures);
    // Key frame 2 sees them on level 1; 1 and 3 too, 0 one or two levels coarser.
    EXPECT_EQ(cull_redundant_keyframes(map, std::vector{kf(2)}, kf(3), model(), {}), dropped);
  }
}

TEST(CullRedundantKeyframes, JudgesByFeaturesWithDepth) {
  Map map = empty_keyframes(4);
  add_keyframe(map, 1, 0.0F);
  see_the_same(map, kFeatures);
  add_keyframe(map);
  EXPECT_EQ(cull_redundant_keyframes(map, std::vector{kf(4)}, kf(5), model(), {}), 0);
}

TEST(CullRedundantKeyframes, FixesTheDroppedToTheMostCovisible) {
  Map map = empty_keyframes(6);
  see_the_same(map, kFeatures);
  for (std::uint32_t i = 0; i < 5; ++i) {
    for (const std::uint32_t other : {0U, 1U, 2U}) {
      map.remove_observation(LandmarkId(i), kf(other));
    }
  }
  const std::vector<KeyframeId> candidates = {kf(3)};
  const CullingConfig config{.redundant_observers = 2};
  EXPECT_EQ(cull_redundant_keyframes(map, candidates, kf(5), model(), config), 1);
  EXPECT_EQ(map.anchor(kf(3)).keyframe, kf(4));
}

}  // namespace
}  // namespace stillmap
