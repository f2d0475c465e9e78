// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/map/map.hpp"

#include <algorithm>
#include <bit>

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "tests/support/random_map.hpp"

namespace stillmap {
namespace {

// Key frames at x = 0, 1, 2, ... that look along z; every feature on level `i % 4`.
Map standing_keyframes(int count) {
  std::mt19937 rng(5);
  Map map(test_scales());
  for (int i = 0; i < count; ++i) {
    Keyframe keyframe = random_keyframe(rng);
    Features features = *keyframe.features;
    for (std::uint32_t f = 0; f < features.size(); ++f) {
      features.level[f] = static_cast<std::uint8_t>(f % 4U);
    }
    keyframe.features = std::make_shared<const Features>(std::move(features));
    keyframe.T_world_camera = Eigen::Isometry3d(Eigen::Translation3d(i, 0, 0));
    map.add_keyframe(std::move(keyframe));
  }
  return map;
}

KeyframeId kf(std::uint32_t value) {
  return KeyframeId(value);
}

TEST(Map, KeepsBothDirectionsOfAnObservation) {
  Map map = standing_keyframes(3);
  const LandmarkId id = map.add_landmark({0, 0, 2}, {kf(1), 4});
  EXPECT_TRUE(map.add_observation(id, {kf(0), 7}));
  EXPECT_EQ(map.keyframe(kf(1)).landmarks[4], id);
  EXPECT_EQ(map.keyframe(kf(0)).landmarks[7], id);
  const std::vector<Observation> by_keyframe = {{kf(0), 7}, {kf(1), 4}};
  EXPECT_EQ(map.landmark(id).observations, by_keyframe);
  EXPECT_EQ(map.landmark(id).created_by, kf(1));
}

TEST(Map, RefusesASecondObservationFromAKeyframeAndATakenFeature) {
  Map map = standing_keyframes(2);
  const LandmarkId a = map.add_landmark({0, 0, 2}, {kf(0), 0});
  const LandmarkId b = map.add_landmark({1, 0, 2}, {kf(1), 3});
  EXPECT_FALSE(map.add_observation(a, {kf(0), 1}));
  EXPECT_FALSE(map.add_observation(a, {kf(1), 3}));
  EXPECT_EQ(map.landmark(a).observations.size(), 1U);
  EXPECT_EQ(map.keyframe(kf(0)).landmarks[1], LandmarkId{});
  EXPECT_EQ(map.keyframe(kf(1)).landmarks[3], b);
}

TEST(Map, DropsALandmarkWithItsLastObservation) {
  Map map = standing_keyframes(2);
  const LandmarkId id = map.add_landmark({0, 0, 2}, {kf(0), 0});
  map.add_observation(id, {kf(1), 1});
  map.remove_observation(id, kf(0));
  EXPECT_NE(map.find(id), nullptr);
  EXPECT_FALSE(map.keyframe(kf(0)).landmarks[0].valid());
  map.remove_observation(id, kf(1));
  EXPECT_EQ(map.find(id), nullptr);
  EXPECT_EQ(map.landmark_count(), 0U);
}

TEST(Map, RefreshDerivesDirectionAndDistancesByHand) {
  Map map = standing_keyframes(3);
  // From (0,0,0) on level 2 (scale 1.5), and from (2,0,0): directions (1,0,2) and (-1,0,2).
  const LandmarkId id = map.add_landmark({1, 0, 2}, {kf(2), 0});
  map.add_observation(id, {kf(0), 2});
  map.refresh(id);
  const Landmark& landmark = map.landmark(id);
  EXPECT_LT((landmark.viewing_direction - Eigen::Vector3d(0, 0, 1)).norm(), 1e-12);
  EXPECT_NEAR(landmark.max_distance_m, std::sqrt(5.0) * 1.5, 1e-12);
  EXPECT_NEAR(landmark.min_distance_m, std::sqrt(5.0) * 1.5 / 2.0, 1e-12);
}

TEST(Map, RefreshChoosesTheDescriptorInTheMiddle) {
  // 0, 8, 16, 24 bits set and one far off. The distances of the first to all, sorted, are
  // 0 8 16 24 far, those of the second 0 8 8 16 far: least in the middle, and first of its equals.
  Map map(test_scales());
  std::mt19937 rng(5);
  const std::vector<Descriptor> descriptors = {{0, 0, 0, 0},
                                               {0xff, 0, 0, 0},
                                               {0xffff, 0, 0, 0},
                                               {0xffffff, 0, 0, 0},
                                               {0, ~0ULL, ~0ULL, ~0ULL}};
  for (const Descriptor& descriptor : descriptors) {
    Keyframe keyframe = random_keyframe(rng);
    Features features = *keyframe.features;
    features.descriptors[0] = descriptor;
    keyframe.features = std::make_shared<const Features>(std::move(features));
    map.add_keyframe(std::move(keyframe));
  }
  const LandmarkId id = map.add_landmark({9, 9, 9}, {kf(4), 0});
  for (std::uint32_t k = 0; k < 4; ++k) map.add_observation(id, {kf(k), 0});
  EXPECT_EQ(map.landmark(id).descriptor, descriptors[4]);  // of the first observation, until now
  map.refresh(id);
  EXPECT_EQ(map.landmark(id).descriptor, descriptors[1]);
}

TEST(Map, MergeKeepsTheFeatureOfTheOneThatStaysAndAddsCounts) {
  Map map = standing_keyframes(3);
  const LandmarkId gone = map.add_landmark({0, 0, 2}, {kf(0), 0});
  map.add_observation(gone, {kf(1), 0});
  const LandmarkId into = map.add_landmark({0, 0, 2}, {kf(1), 5});
  for (int i = 0; i < 4; ++i) map.count_expected(gone);
  map.count_found(into);
  map.merge_landmarks(gone, into);
  const std::vector<Observation> merged = {{kf(0), 0}, {kf(1), 5}};
  EXPECT_EQ(map.landmark(into).observations, merged);
  EXPECT_FALSE(map.keyframe(kf(1)).landmarks[0].valid());
  EXPECT_EQ(map.landmark(into).times_expected, 6);  // both begin with 1
  EXPECT_EQ(map.landmark(into).times_found, 3);
  EXPECT_EQ(map.find(gone), nullptr);
  // Derived from both observations: directions (0,0,2) and (-1,0,2) / sqrt(5).
  const Eigen::Vector3d mean =
      (Eigen::Vector3d(0, 0, 1) + Eigen::Vector3d(-1, 0, 2) / std::sqrt(5.0)).normalized();
  EXPECT_LT((map.landmark(into).viewing_direction - mean).norm(), 1e-12);
  map.check_consistency();
}

TEST(Map, ResolveFollowsChainsOfMerges) {
  Map map = standing_keyframes(4);
  std::vector<LandmarkId> ids;
  for (std::uint32_t k = 0; k < 4; ++k) ids.push_back(map.add_landmark({0, 0, 2}, {kf(k), 0}));
  map.merge_landmarks(ids[0], ids[1]);
  map.merge_landmarks(ids[1], ids[3]);
  EXPECT_EQ(map.resolve(ids[0]), ids[3]);
  EXPECT_EQ(map.resolve(ids[1]), ids[3]);
  EXPECT_EQ(map.resolve(ids[2]), ids[2]);
  EXPECT_FALSE(map.resolve(LandmarkId{}).valid());
  map.remove_landmark(ids[3]);
  EXPECT_FALSE(map.resolve(ids[0]).valid());
  EXPECT_FALSE(map.resolve(ids[3]).valid());
}

TEST(Map, DroppedKeyframesKeepTheirPlaceOverChainsAndFollowTheirAnchor) {
  std::mt19937 rng(8);
  Map map = random_map(5, 60, rng);
  std::vector<Eigen::Isometry3d> poses;
  for (std::uint32_t k = 0; k < 5; ++k) poses.push_back(map.keyframe(kf(k)).T_world_camera);
  map.remove_keyframe(kf(4), kf(2));
  map.remove_keyframe(kf(2), kf(3));
  map.remove_keyframe(kf(3), kf(1));
  for (std::uint32_t k = 0; k < 5; ++k) {
    EXPECT_TRUE(map.T_world_keyframe(kf(k)).isApprox(poses[k], 1e-12)) << k;
  }
  EXPECT_EQ(map.anchor(kf(4)).keyframe, kf(1));
  EXPECT_EQ(map.anchor(kf(0)).keyframe, kf(0));
  // The anchor moves by M on the left: all that is fixed to it moves along.
  const Eigen::Isometry3d moved = random_pose(rng);
  map.set_pose(kf(1), moved * poses[1]);
  EXPECT_TRUE(map.T_world_keyframe(kf(4)).isApprox(moved * poses[4], 1e-12));
  EXPECT_TRUE(map.T_world_keyframe(kf(0)).isApprox(poses[0], 1e-12));
  map.check_consistency();
}

TEST(Map, ApplyKeepsTheOwnersCounts) {
  Map map = standing_keyframes(2);
  const LandmarkId id = map.add_landmark({0, 0, 2}, {kf(0), 0});
  (void)map.take_changes();
  Map window = map.window(std::vector<KeyframeId>{kf(0)});
  window.set_position(id, {0, 0, 3});
  for (int i = 0; i < 5; ++i) map.count_expected(id);
  map.count_found(id);
  map.apply(window.take_changes());
  EXPECT_EQ(map.landmark(id).p_world, Eigen::Vector3d(0, 0, 3));
  EXPECT_EQ(map.landmark(id).times_expected, 6);
  EXPECT_EQ(map.landmark(id).times_found, 2);
}

TEST(Map, TakenChangesAreTakenOnce) {
  Map map = standing_keyframes(2);
  map.add_landmark({0, 0, 2}, {kf(0), 0});
  const MapUpdate first = map.take_changes();
  EXPECT_EQ(first.keyframes.size(), 2U);
  EXPECT_EQ(first.landmarks.size(), 1U);
  const MapUpdate second = map.take_changes();
  EXPECT_TRUE(second.keyframes.empty() && second.landmarks.empty());
  EXPECT_EQ(second.next_landmark, LandmarkId(1));
}

TEST(Map, ForgetsOldMerges) {
  Map map = standing_keyframes(2);
  const LandmarkId into = map.add_landmark({0, 0, 2}, {kf(0), 0});
  const LandmarkId gone = map.add_landmark({0, 0, 2}, {kf(1), 0});
  map.merge_landmarks(gone, into);
  (void)map.take_changes();
  const MapUpdate nothing = map.take_changes();
  for (int i = 0; i < Map::kMergesKept; ++i) map.apply(nothing);
  EXPECT_EQ(map.resolve(gone), into);
  for (int i = 0; i < Map::kMergesKept; ++i) map.apply(nothing);
  EXPECT_FALSE(map.resolve(gone).valid());
  EXPECT_EQ(map.resolve(into), into);
}

TEST(Map, ConsistencyCheckSeesADanglingObservation) {
  // A window in which a landmark lost an observation of a key frame that the owner has changed
  // meanwhile: applying it breaks the owner, and the check must say so.
  Map map = standing_keyframes(2);
  const LandmarkId id = map.add_landmark({0, 0, 2}, {kf(0), 0});
  map.add_observation(id, {kf(1), 0});
  Map window = map.window(std::vector<KeyframeId>{kf(0)});
  window.set_position(id, {0, 0, 3});
  map.remove_observation(id, kf(1));
  map.apply(window.take_changes());
  EXPECT_THROW(map.check_consistency(), InternalError);
}

}  // namespace
}  // namespace stillmap
