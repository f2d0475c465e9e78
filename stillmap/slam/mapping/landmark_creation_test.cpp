// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/mapping/landmark_creation.hpp"

#include <algorithm>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"
#include "tests/support/simulated_map.hpp"

namespace stillmap {
namespace {

MeasurementModel exact_model() {
  return MeasurementModel({.pixel_sigma_px = 0.5}, simulated_world().level_scales());
}

Eigen::Isometry3d pose_at(const Eigen::Vector3d& place, double yaw = 0) {
  return make_pose(so3_exp(Eigen::Vector3d(0, yaw, 0)), place);
}

const Eigen::Vector3d& position_of(const SimulatedMap& simulated, const Observation& o) {
  return simulated_world().points()[simulated.points[o.keyframe.index()][o.feature]].position;
}

TEST(CreateLandmarksFromDepth, PutsThemWhereTheyAre) {
  SimulatedMap simulated(simulated_world());
  std::mt19937 rng(1);
  const Eigen::Isometry3d pose = pose_at({0.3, -0.2, 0.1}, 0.4);
  const KeyframeId id = add_bare_keyframe(
      simulated, pose, simulated_world().observe(pose, {.missing_depth_share = 0.3}, rng));
  create_landmarks_from_depth(simulated.map, id, simulated_world().camera(), exact_model(), {});
  const Keyframe& keyframe = simulated.map.keyframe(id);
  for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i) {
    EXPECT_EQ(keyframe.landmarks[i].valid(), keyframe.features->depth_m[i] > 0);
    if (!keyframe.landmarks[i].valid()) continue;
    const Landmark& landmark = simulated.map.landmark(keyframe.landmarks[i]);
    EXPECT_LT((landmark.p_world - position_of(simulated, {id, i})).norm(), 1e-5);
    EXPECT_EQ(landmark.created_by, id);
  }
  simulated.map.check_consistency();
}

TEST(CreateLandmarksFromDepth, LeavesFeaturesThatSeeOneAlone) {
  std::mt19937 rng(1);
  const std::vector<Eigen::Isometry3d> poses = {pose_at({0, 0, 0})};
  SimulatedMap simulated = make_true_map(simulated_world(), poses, {}, rng);
  const std::vector<LandmarkId> before = simulated.map.keyframe(KeyframeId(0)).landmarks;
  create_landmarks_from_depth(
      simulated.map, KeyframeId(0), simulated_world().camera(), exact_model(), {});
  EXPECT_EQ(simulated.map.keyframe(KeyframeId(0)).landmarks, before);
}

// Depths of the features that became landmarks.
std::vector<float> chosen_depths(const MeasurementModel& measure,
                                 const LandmarkCreationConfig& config) {
  SimulatedMap simulated(simulated_world());
  std::mt19937 rng(1);
  const KeyframeId id = add_bare_keyframe(
      simulated, pose_at({0, 0, 0}), simulated_world().observe(pose_at({0, 0, 0}), {}, rng));
  create_landmarks_from_depth(simulated.map, id, simulated_world().camera(), measure, config);
  const Keyframe& keyframe = simulated.map.keyframe(id);
  std::vector<float> depths;
  for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i) {
    if (keyframe.landmarks[i].valid()) depths.push_back(keyframe.features->depth_m[i]);
  }
  std::ranges::sort(depths);
  return depths;
}

TEST(CreateLandmarksFromDepth, TakesAllNearOnesAndFarOnesUpToANumber) {
  std::vector<float> all = chosen_depths(exact_model(), {});
  ASSERT_GT(all.size(), 250U);
  const auto near = static_cast<std::size_t>(
      std::ranges::count_if(all, [](float depth) { return depth <= 2.5F; }));
  ASSERT_GT(near, 20U);
  const auto first = [&](std::size_t count) {
    return std::vector(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
  };
  const LandmarkCreationConfig few{.max_depth_m = 2.5, .min_landmarks = 5};
  EXPECT_EQ(chosen_depths(exact_model(), few), first(near));
  const LandmarkCreationConfig many{.max_depth_m = 2.5, .min_landmarks = 200};
  EXPECT_EQ(chosen_depths(exact_model(), many), first(200));
  const MeasurementModel blind_beyond({.max_depth_m = 2.5}, simulated_world().level_scales());
  EXPECT_EQ(chosen_depths(blind_beyond, many), first(near));
}

// Two key frames. Every third point is a landmark that both see; of the others the depth is unknown
// to both.
SimulatedMap two_views(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  SimulatedMap simulated(simulated_world());
  std::mt19937 rng(1);
  for (const Eigen::Isometry3d& pose : {a, b}) {
    Observed seen = simulated_world().observe(pose, {}, rng);
    for (std::size_t i = 0; i < seen.points.size(); ++i) {
      if (seen.points[i] % 3 != 0) seen.features.depth_m[i] = 0;
    }
    const KeyframeId id = add_bare_keyframe(simulated, pose, std::move(seen));
    const std::vector<std::uint32_t>& points = simulated.points[id.index()];
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (points[i] % 3 != 0) continue;
      const Eigen::Vector3d& p = simulated_world().points()[points[i]].position;
      const auto [known, is_new] = simulated.landmark_of_point.try_emplace(points[i]);
      if (is_new) known->second = simulated.map.add_landmark(p, {id, i});
      if (!is_new) simulated.map.add_observation(known->second, {id, i});
    }
  }
  return simulated;
}

double parallax_deg(const Eigen::Vector3d& p,
                    const Eigen::Isometry3d& a,
                    const Eigen::Isometry3d& b) {
  const Eigen::Vector3d ray_a = (p - a.translation()).normalized();
  const Eigen::Vector3d ray_b = (p - b.translation()).normalized();
  return std::acos(ray_a.dot(ray_b)) * 180.0 / std::numbers::pi;
}

// Points without depth that both see under more than `min_parallax_deg`.
std::set<std::uint32_t> triangulable(const SimulatedMap& simulated, double min_parallax_deg) {
  const Eigen::Isometry3d &a = simulated.T_world_keyframe[0], &b = simulated.T_world_keyframe[1];
  const std::set<std::uint32_t> in_b(simulated.points[1].begin(), simulated.points[1].end());
  std::set<std::uint32_t> both;
  for (const std::uint32_t point : simulated.points[0]) {
    const Eigen::Vector3d& p = simulated_world().points()[point].position;
    if (point % 3 != 0 && in_b.contains(point) && parallax_deg(p, a, b) > min_parallax_deg) {
      both.insert(point);
    }
  }
  return both;
}

TEST(TriangulateLandmarks, FindsWhatTwoViewsSeeUnderEnoughParallax) {
  SimulatedMap simulated = two_views(pose_at({0, 0, 0}), pose_at({0.1, 0.03, 0.02}, -0.05));
  const std::set<std::uint32_t> expected = triangulable(simulated, 2.0);
  ASSERT_GT(expected.size(), 100U);
  ASSERT_LT(expected.size() + 50, triangulable(simulated, 0.0).size());
  const int made = triangulate_landmarks(simulated.map,
                                         KeyframeId(1),
                                         simulated_world().camera(),
                                         exact_model(),
                                         {.min_parallax_deg = 2.0});
  EXPECT_EQ(made, static_cast<int>(expected.size()));
  std::set<std::uint32_t> found;
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    const Landmark& landmark = simulated.map.landmark(id);
    const std::uint32_t point = true_point(simulated, landmark);
    if (point % 3 == 0) continue;
    found.insert(point);
    ASSERT_EQ(landmark.observations.size(), 2U);
    EXPECT_LT((landmark.p_world - position_of(simulated, landmark.observations[0])).norm(), 2e-4);
    EXPECT_LT((landmark.p_world - position_of(simulated, landmark.observations[1])).norm(), 2e-4);
  }
  EXPECT_EQ(found, expected);
  simulated.map.check_consistency();
}

TEST(TriangulateLandmarks, MakesNothingWithoutParallax) {
  SimulatedMap near = two_views(pose_at({0, 0, 0}), pose_at({0.01, 0, 0}));
  SimulatedMap turned = two_views(pose_at({0, 0, 0}), pose_at({0, 0, 0}, 0.1));
  for (SimulatedMap* simulated : {&near, &turned}) {
    ASSERT_GT(triangulable(*simulated, -1).size(), 100U);
    EXPECT_EQ(triangulate_landmarks(
                  simulated->map, KeyframeId(1), simulated_world().camera(), exact_model(), {}),
              0);
  }
}

TEST(TriangulateLandmarks, MakesNothingOfFeaturesThatLookAlikeButDoNotMeet) {
  SimulatedMap simulated = two_views(pose_at({0, 0, 0}), pose_at({0.3, 0, 0}));
  // Epipolar lines are the rows: every free feature of the second moves 30 rows down.
  Map map(simulated_world().level_scales());
  for (std::uint32_t k = 0; k < 2; ++k) {
    Keyframe keyframe = simulated.map.keyframe(KeyframeId(k));
    Features features = *keyframe.features;
    for (std::size_t i = 0; i < features.size() && k == 1; ++i) features.px[i].y() += 30;
    keyframe.features = std::make_shared<const Features>(std::move(features));
    map.add_keyframe(std::move(keyframe));
  }
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    const Landmark& landmark = simulated.map.landmark(id);
    const LandmarkId copy = map.add_landmark(landmark.p_world, landmark.observations[0]);
    if (landmark.observations.size() == 2) map.add_observation(copy, landmark.observations[1]);
  }
  EXPECT_EQ(
      triangulate_landmarks(map, KeyframeId(1), simulated_world().camera(), exact_model(), {}), 0);
}

TEST(TriangulateLandmarks, AsksOnlyAsManyNeighborsAsAllowed) {
  SimulatedMap simulated = two_views(pose_at({0, 0, 0}), pose_at({0.3, 0, 0}));
  EXPECT_EQ(triangulate_landmarks(simulated.map,
                                  KeyframeId(1),
                                  simulated_world().camera(),
                                  exact_model(),
                                  {.neighbors = 0}),
            0);
}

}  // namespace
}  // namespace stillmap
