// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/mapping/map_adjustment.hpp"

#include <set>

#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"
#include "tests/support/simulated_map.hpp"

namespace stillmap {
namespace {

constexpr ObservationNoise kFineNoise{.pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.004};

MeasurementModel fine_model() {
  return MeasurementModel({.pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.004},
                          simulated_world().level_scales());
}

// Six key frames along a bow, as they truly are but for the noise of their features.
SimulatedMap bow() {
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < 6; ++k) {
    poses.push_back(make_pose(so3_exp(Eigen::Vector3d(0.02 * k, 0.05 * k, 0)),
                              Eigen::Vector3d(0.12 * k, 0.03 * k, -0.05 * k)));
  }
  std::mt19937 rng(1);
  return make_true_map(simulated_world(), poses, kFineNoise, rng);
}

// Moves key frames by about 2 cm and 0.6 degrees, and all landmarks by about 7 cm.
void perturb(SimulatedMap& simulated, std::span<const KeyframeId> keyframes) {
  std::mt19937 rng(2);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Eigen::Vector3d(normal(rng), normal(rng), normal(rng)); };
  for (const KeyframeId id : keyframes) {
    const Eigen::Isometry3d off = make_pose(so3_exp(0.006 * vector()), 0.012 * vector());
    simulated.map.set_pose(id, simulated.map.keyframe(id).T_world_camera * off);
  }
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    simulated.map.set_position(id, simulated.map.landmark(id).p_world + 0.04 * vector());
    simulated.map.refresh(id);
  }
}

struct Errors {
  double keyframes_m = 0;  // root mean squares
  double keyframes_rad = 0;
  double landmarks_m = 0;  // of those that at least four see
};

Errors errors_of(const SimulatedMap& simulated) {
  Errors errors;
  for (const auto& [id, keyframe] : simulated.map.keyframes()) {
    const Eigen::Isometry3d& truth = simulated.T_world_keyframe[id.index()];
    const Eigen::Isometry3d off = truth.inverse() * keyframe.T_world_camera;
    errors.keyframes_m += off.translation().squaredNorm();
    errors.keyframes_rad += std::pow(rotation_angle(off.linear()), 2);
  }
  int landmarks = 0;
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    const Landmark& landmark = simulated.map.landmark(id);
    if (landmark.observations.size() < 4) continue;
    ++landmarks;
    const Eigen::Vector3d& truth =
        simulated_world().points()[true_point(simulated, landmark)].position;
    errors.landmarks_m += (landmark.p_world - truth).squaredNorm();
  }
  const auto keyframes = static_cast<double>(simulated.map.keyframes().size());
  return {std::sqrt(errors.keyframes_m / keyframes),
          std::sqrt(errors.keyframes_rad / keyframes),
          std::sqrt(errors.landmarks_m / landmarks)};
}

TEST(AdjustMap, BringsPosesAndPointsBackToTheTruth) {
  SimulatedMap simulated = bow();
  const std::vector<KeyframeId> free = {
      KeyframeId(1), KeyframeId(2), KeyframeId(3), KeyframeId(4), KeyframeId(5)};
  perturb(simulated, free);
  const Errors before = errors_of(simulated);
  adjust_map(simulated.map, free, simulated_world().camera(), fine_model(), {});
  const Errors after = errors_of(simulated);
  EXPECT_LT(after.keyframes_m, 0.15 * before.keyframes_m);
  EXPECT_LT(after.keyframes_rad, 0.15 * before.keyframes_rad);
  EXPECT_LT(after.landmarks_m, 0.3 * before.landmarks_m);
  simulated.map.check_consistency();
}

TEST(AdjustMap, HoldsTheFirstKeyframeAndAllThatAreNotFree) {
  SimulatedMap simulated = bow();
  perturb(simulated, std::vector{KeyframeId(0), KeyframeId(1), KeyframeId(2), KeyframeId(3)});
  const SimulatedMap before = simulated;
  adjust_map(simulated.map,
             std::vector{KeyframeId(0), KeyframeId(3)},
             simulated_world().camera(),
             fine_model(),
             {});
  for (const auto& [id, keyframe] : simulated.map.keyframes()) {
    const Eigen::Isometry3d& was = before.map.keyframe(id).T_world_camera;
    EXPECT_EQ(keyframe.T_world_camera.isApprox(was, 0), id != KeyframeId(3)) << id.value;
  }
}

TEST(AdjustMap, MovesOnlyLandmarksThatAFreeKeyframeSees) {
  SimulatedMap simulated = bow();
  perturb(simulated, {});
  const SimulatedMap before = simulated;
  adjust_map(
      simulated.map, std::vector{KeyframeId(5)}, simulated_world().camera(), fine_model(), {});
  int moved = 0, stayed = 0;
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    bool seen = false;
    for (const Observation& o : before.map.landmark(id).observations) {
      seen = seen || o.keyframe == KeyframeId(5);
    }
    const bool same = simulated.map.landmark(id).p_world == before.map.landmark(id).p_world;
    EXPECT_EQ(same, !seen) << id.value;
    ++(same ? stayed : moved);
  }
  EXPECT_GT(moved, 100);
  EXPECT_GT(stayed, 20);
}

TEST(AdjustMap, RemovesObservationsOfOtherPoints) {
  SimulatedMap simulated = bow();
  // Swaps what two far-apart features of key frame 3 see, a dozen times.
  std::set<LandmarkId> mixed;
  const std::vector<LandmarkId> seen = simulated.map.keyframe(KeyframeId(3)).landmarks;
  for (std::uint32_t i = 0; i < 24; i += 2) {
    const LandmarkId a = seen[i], b = seen[i + 1];
    if (simulated.map.landmark(a).observations.size() < 4) continue;
    if (simulated.map.landmark(b).observations.size() < 4) continue;
    simulated.map.remove_observation(a, KeyframeId(3));
    simulated.map.remove_observation(b, KeyframeId(3));
    ASSERT_TRUE(simulated.map.add_observation(a, {KeyframeId(3), i + 1}));
    ASSERT_TRUE(simulated.map.add_observation(b, {KeyframeId(3), i}));
    mixed.insert({a, b});
  }
  ASSERT_GT(mixed.size(), 6U);
  std::size_t before = 0, after = 0;
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    before += simulated.map.landmark(id).observations.size();
  }
  adjust_map(simulated.map,
             std::vector{KeyframeId(1), KeyframeId(2), KeyframeId(3), KeyframeId(4), KeyframeId(5)},
             simulated_world().camera(),
             fine_model(),
             {});
  for (const LandmarkId id : mixed) {
    const Landmark& landmark = simulated.map.landmark(id);
    for (const Observation& o : landmark.observations) EXPECT_NE(o.keyframe, KeyframeId(3));
    EXPECT_LT(
        (landmark.p_world - simulated_world().points()[true_point(simulated, landmark)].position)
            .norm(),
        0.1);
  }
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    after += simulated.map.landmark(id).observations.size();
  }
  EXPECT_GT(after, 0.93 * static_cast<double>(before));  // of the right ones 5 % at most go
  simulated.map.check_consistency();
}

TEST(AdjustMap, RefreshesWhatItMoved) {
  SimulatedMap simulated = bow();
  const std::vector<KeyframeId> free = {
      KeyframeId(1), KeyframeId(2), KeyframeId(3), KeyframeId(4), KeyframeId(5)};
  perturb(simulated, free);
  adjust_map(simulated.map, free, simulated_world().camera(), fine_model(), {});
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    const Landmark adjusted = simulated.map.landmark(id);
    simulated.map.refresh(id);
    const Landmark& refreshed = simulated.map.landmark(id);
    EXPECT_EQ(adjusted.viewing_direction, refreshed.viewing_direction);
    EXPECT_EQ(adjusted.max_distance_m, refreshed.max_distance_m);
  }
}

}  // namespace
}  // namespace stillmap
