// SPDX-License-Identifier: Apache-2.0
// Several submaps in one map, and how one becomes part of another.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/slam/map/map.hpp"
#include "tests/support/random_map.hpp"
#include "tests/support/same_map.hpp"

namespace stillmap {
namespace {

using testing::ElementsAre;

constexpr SubmapId kInto{0}, kGone{1}, kOther{7};

Eigen::Isometry3d at(double x) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0));
}

// A quarter turn about z and a step: (x, y, z) becomes (1 - y, 2 + x, 3 + z).
Eigen::Isometry3d quarter_turn() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.matrix() << 0, -1, 0, 1,  //
      1, 0, 0, 2,             //
      0, 0, 1, 3,             //
      0, 0, 0, 1;
  return T;
}

// Key frames k at x = k, whose submaps take turns; two landmarks in each submap but the last, which
// has one. Key frame 5 is dropped and fixed to 4.
class MapSubmaps : public testing::Test {
 protected:
  MapSubmaps() {
    for (const SubmapId submap : {kInto, kGone, kInto, kOther, kGone, kGone}) add_keyframe(submap);
    map_.remove_keyframe(KeyframeId(5), KeyframeId(4));
    in_into_ = map_.add_landmark({0, 0, 2}, {KeyframeId(0), 0});
    map_.add_observation(in_into_, {KeyframeId(2), 0});
    map_.add_landmark({2, 0, 4}, {KeyframeId(2), 1});
    in_gone_ = map_.add_landmark({5, 1, 2}, {KeyframeId(1), 3});
    map_.add_observation(in_gone_, {KeyframeId(4), 4});
    map_.refresh(in_gone_);
    once_in_gone_ = map_.add_landmark({4, 0, 6}, {KeyframeId(4), 5});
    in_other_ = map_.add_landmark({3, 3, 3}, {KeyframeId(3), 2});
    (void)map_.take_changes();
  }

  KeyframeId add_keyframe(SubmapId submap) {
    Keyframe keyframe = random_keyframe(rng_);
    keyframe.submap = submap;
    keyframe.is_origin = true;  // the map decides
    keyframe.T_world_camera = at(next_x_++);
    return map_.add_keyframe(std::move(keyframe));
  }

  std::vector<std::uint32_t> origins() const {
    std::vector<std::uint32_t> ids;
    for (const auto& [id, keyframe] : map_.keyframes()) {
      if (keyframe.is_origin) ids.push_back(id.value);
    }
    return ids;
  }

  std::mt19937 rng_{3};
  double next_x_ = 0;
  Map map_{test_scales()};
  LandmarkId in_into_, in_gone_, once_in_gone_, in_other_;
};

TEST_F(MapSubmaps, AreThoseOfTheKeyFramesSorted) {
  EXPECT_THAT(map_.submaps(), ElementsAre(kInto, kGone, kOther));
  EXPECT_TRUE(Map(test_scales()).submaps().empty());
}

TEST_F(MapSubmaps, FirstKeyFrameOfEachIsItsOrigin) {
  EXPECT_THAT(origins(), ElementsAre(0, 1, 3));
  EXPECT_TRUE(map_.keyframe(add_keyframe(SubmapId(2))).is_origin);
  EXPECT_FALSE(map_.keyframe(add_keyframe(kOther)).is_origin);
  EXPECT_THROW(map_.remove_keyframe(KeyframeId(3), KeyframeId(0)), InternalError);
}

TEST_F(MapSubmaps, JoinMovesAllKeyFramesOfTheOneThatGoes) {
  map_.join_submaps(kGone, kInto, quarter_turn());
  map_.check_consistency();
  EXPECT_THAT(map_.submaps(), ElementsAre(kInto, kOther));
  EXPECT_THAT(origins(), ElementsAre(0, 3));
  for (const std::uint32_t k : {1U, 4U}) {
    const Keyframe& moved = map_.keyframe(KeyframeId(k));
    EXPECT_EQ(moved.submap, kInto);
    EXPECT_EQ(moved.T_world_camera.translation(), Eigen::Vector3d(1, 2 + k, 3));
    EXPECT_EQ(moved.T_world_camera.linear(), quarter_turn().linear());
  }
  // The dropped one stood at x = 5.
  EXPECT_EQ(map_.T_world_keyframe(KeyframeId(5)).translation(), Eigen::Vector3d(1, 7, 3));
}

TEST_F(MapSubmaps, JoinMovesLandmarksOnceAndTurnsTheirDirections) {
  const Landmark before = map_.landmark(in_gone_);
  map_.join_submaps(kGone, kInto, quarter_turn());
  const Landmark& landmark = map_.landmark(in_gone_);
  EXPECT_EQ(landmark.p_world, Eigen::Vector3d(0, 7, 5));
  EXPECT_EQ(map_.landmark(once_in_gone_).p_world, Eigen::Vector3d(1, 6, 9));
  EXPECT_EQ(map_.landmark(once_in_gone_).viewing_direction, Eigen::Vector3d(0, 0, 1));
  // Seen from x = 1 and x = 4: along (4, 1, 2) and (1, 1, 2), of which x becomes y, and y -x.
  const Eigen::Vector3d direction =
      (Eigen::Vector3d(-1, 4, 2) / std::sqrt(21.0) + Eigen::Vector3d(-1, 1, 2) / std::sqrt(6.0))
          .normalized();
  EXPECT_LT((landmark.viewing_direction - direction).norm(), 1e-12);
  EXPECT_EQ(landmark.observations, before.observations);
  EXPECT_EQ(landmark.created_by, before.created_by);
  EXPECT_EQ(landmark.max_distance_m, before.max_distance_m);
}

TEST_F(MapSubmaps, JoinLeavesTheRestAsItIs) {
  const Map before = map_;
  map_.join_submaps(kGone, kInto, quarter_turn());
  for (const std::uint32_t k : {0U, 2U, 3U}) {
    expect_same(map_.keyframe(KeyframeId(k)), before.keyframe(KeyframeId(k)));
  }
  for (const LandmarkId id : before.landmark_ids()) {
    if (id != in_gone_ && id != once_in_gone_) expect_same(map_.landmark(id), before.landmark(id));
  }
  EXPECT_EQ(map_.landmark_ids(), before.landmark_ids());
  // What was changed is told, and nothing else.
  const MapUpdate changes = map_.take_changes();
  ASSERT_EQ(changes.keyframes.size(), 2U);
  EXPECT_EQ(changes.keyframes[0].id, KeyframeId(1));
  EXPECT_EQ(changes.keyframes[1].id, KeyframeId(4));
  ASSERT_EQ(changes.landmarks.size(), 2U);
  EXPECT_EQ(changes.landmarks[0].id, in_gone_);
  EXPECT_EQ(changes.landmarks[1].id, once_in_gone_);
}

TEST_F(MapSubmaps, LaterOneMayTakeTheEarlier) {
  map_.join_submaps(kInto, kOther, at(100));
  EXPECT_THAT(map_.submaps(), ElementsAre(kGone, kOther));
  EXPECT_THAT(origins(), ElementsAre(1, 3));
  EXPECT_EQ(map_.landmark(in_into_).p_world, Eigen::Vector3d(100, 0, 2));
  EXPECT_EQ(map_.landmark(in_other_).p_world, Eigen::Vector3d(3, 3, 3));
  // The submap that is gone may begin anew.
  EXPECT_TRUE(map_.keyframe(add_keyframe(kInto)).is_origin);
  EXPECT_THROW(map_.join_submaps(kGone, kGone, at(0)), InternalError);
}

TEST_F(MapSubmaps, JoinedOnesMakeAMapThatCanBeSaved) {
  map_.join_submaps(kGone, kInto, quarter_turn());
  const MapParts parts = map_.parts();
  EXPECT_EQ(std::ranges::count(parts.keyframes, true, &Keyframe::is_origin), 2);
  for (const Keyframe& keyframe : parts.keyframes) EXPECT_TRUE(is_rigid(keyframe.T_world_camera));
}

}  // namespace
}  // namespace stillmap
