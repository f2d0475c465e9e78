// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/loop/global_adjustment.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "stillmap/slam/map/covisibility.hpp"
#include "tests/support/loops.hpp"
#include "tests/support/same_map.hpp"

namespace stillmap {
namespace {

KeyframeId kf(std::uint32_t value) {
  return KeyframeId(value);
}

double mean_landmark_error_m(const SimulatedMap& simulated, const SimulatedWorld& world) {
  double sum = 0;
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    const Landmark& landmark = simulated.map.landmark(id);
    sum += (landmark.p_world - world.points()[true_point(simulated, landmark)].position).norm();
  }
  return sum / static_cast<double>(simulated.map.landmark_count());
}

// The first quarter of a round, drifted: what key frames have in common says by how much.
class GlobalAdjustment : public testing::Test {
 protected:
  static constexpr std::uint32_t kKeyframes = 10;

  [[nodiscard]] GlobalCorrection adjusted() const {
    return adjust_globally(
        submap_window(map_, SubmapId(0)), world_.camera(), loop_measure(world_), {});
  }

  // A landmark that at least four key frames see, among them this one.
  [[nodiscard]] LandmarkId landmark_of(KeyframeId keyframe, std::size_t number) const {
    for (const LandmarkId id : map_.keyframe(keyframe).landmarks) {
      if (id.valid() && map_.landmark(id).observations.size() >= 4 && number-- == 0) return id;
    }
    ADD_FAILURE() << "no such landmark";
    return {};
  }

  // As tracking and mapping do it: as far off as key frame `like`. `place`: see round_pose().
  KeyframeId add_keyframe_like(KeyframeId like, std::uint32_t place) {
    const Eigen::Isometry3d& T = map_.keyframe(like).T_world_camera;
    const Eigen::Isometry3d motion = T * round_pose(like.value).inverse();
    const Eigen::Isometry3d pose = round_pose(place);
    std::mt19937 rng(place);
    const KeyframeId id =
        add_true_keyframe(simulated_, world_, pose, world_.observe(pose, RoundSpec{}.noise, rng));
    map_.set_pose(id, motion * pose);
    for (const LandmarkId landmark : map_.keyframe(id).landmarks) {
      const Landmark& made = map_.landmark(landmark);
      if (made.created_by == id) map_.set_position(landmark, motion * made.p_world);
    }
    return id;
  }

  [[nodiscard]] Eigen::Isometry3d between(KeyframeId a, KeyframeId b) const {
    return map_.T_world_keyframe(a).inverse() * map_.T_world_keyframe(b);
  }

  [[nodiscard]] Eigen::Vector3d seen_from(KeyframeId a, LandmarkId landmark) const {
    return map_.T_world_keyframe(a).inverse() * map_.landmark(landmark).p_world;
  }

  const SimulatedWorld world_{{.points = 2000}, simulated_camera()};
  SimulatedMap simulated_ = drifted_round(world_, {.keyframes = kKeyframes});
  Map& map_ = simulated_.map;
};

TEST_F(GlobalAdjustment, TheDriftGoes) {
  const double before_m = mean_error_m(simulated_);
  const double landmarks_before_m = mean_landmark_error_m(simulated_, world_);
  const GlobalCorrection correction = adjusted();
  EXPECT_EQ(correction.T_world_camera.size(), kKeyframes);
  EXPECT_EQ(mean_error_m(simulated_), before_m);  // nothing yet
  apply_correction(map_, correction);
  map_.check_consistency();
  EXPECT_GT(before_m, 0.02);
  EXPECT_LT(mean_error_m(simulated_), before_m / 3);
  EXPECT_LT(mean_landmark_error_m(simulated_, world_), landmarks_before_m);
  EXPECT_EQ(map_.keyframe(kf(0)).T_world_camera.matrix(), round_pose(0).matrix());
  for (const auto& [id, T_world_camera] : correction.T_world_camera) {
    EXPECT_LT(difference(map_.keyframe(id).T_world_camera, T_world_camera).maxCoeff(), 1e-9);
  }
  for (const auto& [id, position] : correction.positions) {
    const Landmark* landmark = map_.find(id);
    if (landmark == nullptr) continue;
    EXPECT_EQ(landmark->p_world, position);
  }
}

TEST_F(GlobalAdjustment, WhatDoesNotFitGoes) {
  // The feature of one point is said to see another.
  const LandmarkId right = landmark_of(kf(5), 0), robbed = landmark_of(kf(5), 30);
  const std::vector<LandmarkId>& seen = map_.keyframe(kf(5)).landmarks;
  const auto feature = static_cast<std::uint32_t>(std::ranges::find(seen, robbed) - seen.begin());
  map_.remove_observation(right, kf(5));
  map_.remove_observation(robbed, kf(5));
  ASSERT_TRUE(map_.add_observation(right, {kf(5), feature}));
  const GlobalCorrection correction = adjusted();
  const std::pair<LandmarkId, KeyframeId> wrong(right, kf(5));
  EXPECT_EQ(std::ranges::count(correction.outliers, wrong), 1);

  Map without = map_;  // where mapping has seen to it meanwhile
  without.remove_observation(right, kf(5));
  apply_correction(without, correction);
  without.check_consistency();
  apply_correction(map_, correction);
  map_.check_consistency();
  for (const Map* map : {&std::as_const(map_), &std::as_const(without)}) {
    ASSERT_NE(map->find(right), nullptr);
    EXPECT_GE(map->landmark(right).observations.size(), 3U);
    EXPECT_FALSE(map->keyframe(kf(5)).landmarks[feature].valid());
  }
}

TEST_F(GlobalAdjustment, KeyFramesThatHaveComeSinceFollowTheirNeighbours) {
  const GlobalCorrection correction = adjusted();
  const KeyframeId added = add_keyframe_like(kf(kKeyframes - 1), kKeyframes);
  const KeyframeId next = add_keyframe_like(added, kKeyframes + 1);
  const KeyframeId back = add_keyframe_like(kf(4), 4);  // a place that was seen before
  std::mt19937 rng(1);
  const KeyframeId blind = add_bare_keyframe(
      simulated_, round_pose(20), world_.observe(round_pose(20), {.pixel_sigma_px = 0.5}, rng));
  const auto neighbour = [&](KeyframeId id) { return covisible_keyframes(map_, id).front().id; };
  ASSERT_EQ(neighbour(next), added);
  ASSERT_LT(neighbour(back), kf(kKeyframes));
  const std::vector<std::pair<KeyframeId, KeyframeId>> pairs = {
      {neighbour(added), added}, {added, next}, {neighbour(back), back}, {back, blind}};
  std::vector<Eigen::Isometry3d> before;
  for (const auto& [a, b] : pairs) before.push_back(between(a, b));
  const auto error_m = [&](KeyframeId id) {
    return difference(map_.keyframe(id).T_world_camera, simulated_.T_world_keyframe[id.index()])
        .x();
  };
  const double error_before_m = error_m(next);

  apply_correction(map_, correction);
  map_.check_consistency();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Isometry3d after = between(pairs[i].first, pairs[i].second);
    EXPECT_LT(difference(after, before[i]).maxCoeff(), 1e-7) << i;
  }
  EXPECT_GT(error_before_m, 0.04);
  EXPECT_LT(error_m(next), error_before_m / 3);
}

TEST_F(GlobalAdjustment, LandmarksThatHaveComeSinceFollowTheirMakers) {
  const GlobalCorrection correction = adjusted();
  const KeyframeId added = add_keyframe_like(kf(kKeyframes - 1), kKeyframes);
  std::map<LandmarkId, Eigen::Vector3d> p_added;
  for (const LandmarkId id : map_.keyframe(added).landmarks) {
    if (map_.landmark(id).created_by == added) p_added[id] = seen_from(added, id);
  }
  ASSERT_GT(p_added.size(), 10U);
  const Eigen::Vector3d one_before = map_.landmark(p_added.begin()->first).p_world;
  apply_correction(map_, correction);
  map_.check_consistency();
  for (const auto& [id, p] : p_added) EXPECT_LT((seen_from(added, id) - p).norm(), 1e-9);
  EXPECT_GT((map_.landmark(p_added.begin()->first).p_world - one_before).norm(), 0.02);
}

TEST_F(GlobalAdjustment, WhatHasGoneSinceIsNotMissed) {
  const GlobalCorrection correction = adjusted();
  const LandmarkId removed = landmark_of(kf(3), 0);
  map_.remove_landmark(removed);
  const LandmarkId gone = landmark_of(kf(3), 1), into = landmark_of(kf(3), 2);
  map_.merge_landmarks(gone, into);
  // Made since by a key frame that is dropped then: it stays with the other one that sees it.
  const LandmarkId replaced_5 = landmark_of(kf(5), 3);
  const std::vector<Observation> seen = map_.landmark(replaced_5).observations;
  map_.remove_landmark(replaced_5);
  const auto by = [&](std::uint32_t k) {
    return *std::ranges::find(seen, kf(k), &Observation::keyframe);
  };
  const LandmarkId made = map_.add_landmark({0.3, 0.2, 3}, by(5));
  map_.add_observation(made, by(6));
  map_.remove_keyframe(kf(5), kf(4));
  const Eigen::Isometry3d T_4_5 = between(kf(4), kf(5));
  const Eigen::Vector3d p_6 = seen_from(kf(6), made);
  const double before_m = mean_error_m(simulated_);

  apply_correction(map_, correction);
  map_.check_consistency();
  EXPECT_LT(mean_error_m(simulated_), before_m / 3);
  EXPECT_FALSE(map_.has(kf(5)));
  EXPECT_LT(difference(between(kf(4), kf(5)), T_4_5).maxCoeff(), 1e-7);
  EXPECT_EQ(map_.find(removed), nullptr);
  EXPECT_EQ(map_.find(gone), nullptr);
  EXPECT_EQ(map_.resolve(gone), into);
  const auto corrected =
      std::ranges::find(correction.positions, into, &std::pair<LandmarkId, Eigen::Vector3d>::first);
  ASSERT_NE(corrected, correction.positions.end());
  EXPECT_EQ(map_.landmark(into).p_world, corrected->second);
  EXPECT_LT((seen_from(kf(6), made) - p_6).norm(), 1e-9);
}

TEST_F(GlobalAdjustment, OtherSubmapsStayAsTheyAre) {
  SimulatedMap two =
      drifted_round(world_,
                    {.keyframes = kKeyframes,
                     .second_submap_from = 6,
                     .T_second_first = make_pose(so3_exp(Eigen::Vector3d(0.5, 1, 2)), {2, 3, 4})});
  const Map before = two.map;
  const Map window = submap_window(two.map, SubmapId(0));
  EXPECT_EQ(window.keyframes().size(), 6U);
  EXPECT_EQ(window.submaps(), std::vector<SubmapId>{SubmapId(0)});
  apply_correction(two.map, adjust_globally(window, world_.camera(), loop_measure(world_), {}));
  two.map.check_consistency();
  EXPECT_NE(two.map.keyframe(kf(5)).T_world_camera.matrix(),
            before.keyframe(kf(5)).T_world_camera.matrix());
  for (std::uint32_t k = 6; k < kKeyframes; ++k) {
    expect_same(two.map.keyframe(kf(k)), before.keyframe(kf(k)));
    for (const LandmarkId id : before.keyframe(kf(k)).landmarks) {
      expect_same(two.map.landmark(id), before.landmark(id));
    }
  }
}

}  // namespace
}  // namespace stillmap
