// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/tracking/relocalizer.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/paths.hpp"
#include "tests/support/simulated_map.hpp"

namespace stillmap {
namespace {

constexpr ObservationNoise kNoise{
    .pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.01, .flipped_bits = 15};

Eigen::Isometry3d yawed(double degrees) {
  return make_pose(so3_exp(Eigen::Vector3d(0, degrees * 3.14159265358979 / 180, 0)),
                   Eigen::Vector3d::Zero());
}

Relocalizer make_relocalizer(const SimulatedWorld& world,
                             const RelocalizerConfig& config = {},
                             std::uint32_t seed = 0) {
  const MeasurementModel measure({.pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.01},
                                 world.level_scales());
  return Relocalizer(config, world.camera(), measure, seed);
}

// Key frames all round, 30 degrees apart.
SimulatedMap map_all_round(const SimulatedWorld& world) {
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < 12; ++k) poses.push_back(yawed(30 * k));
  std::mt19937 rng(4);
  return make_true_map(world, poses, kNoise, rng);
}

TEST(Relocalizer, FindsThePoseAmongKeyframes) {
  const SimulatedWorld world({}, simulated_camera());
  const SimulatedMap simulated = map_all_round(world);
  const Relocalizer relocalizer = make_relocalizer(world);
  std::mt19937 rng(5);
  for (const double degrees : {5.0, 95.0, 200.0}) {
    Eigen::Isometry3d truth = yawed(degrees);
    truth.translation() = Eigen::Vector3d(0.2, -0.1, 0.15);
    const Observed seen = world.observe(truth, kNoise, rng);
    std::optional<Relocalization> found;
    for (std::uint32_t frame = 0; frame < 4 && !found; ++frame) {
      found =
          relocalizer.find(FrameId(frame), seen.features, simulated.map, index_of(simulated.map));
    }
    ASSERT_TRUE(found) << degrees;
    EXPECT_LT((found->T_camera_world.inverse().translation() - truth.translation()).norm(), 0.03);
    EXPECT_LT(rotation_angle((found->T_camera_world * truth).linear()), 0.005);
    EXPECT_GE(found->matches.size(), 50U);
    EXPECT_GT(found->share, 0.5);
    for (const auto& [feature, landmark] : found->matches) {
      EXPECT_EQ(seen.points[feature], true_point(simulated, simulated.map.landmark(landmark)));
    }
  }
}

TEST(Relocalizer, FindsItAmongManyWrongMatches) {
  const SimulatedWorld world({}, simulated_camera());
  const SimulatedMap simulated = map_all_round(world);
  std::mt19937 rng(5);
  Observed seen = world.observe(yawed(10), kNoise, rng);
  // Half of the features look like another feature.
  for (std::size_t i = 2; i < seen.features.size(); i += 2) {
    std::swap(seen.features.descriptors[i], seen.features.descriptors[i - 2]);
    seen.features.angle_deg[i] = seen.features.angle_deg[i - 2];
  }
  // So half of the landmarks cannot be found.
  const std::optional<Relocalization> found =
      make_relocalizer(world, {.min_share = 0.3})
          .find(FrameId(0), seen.features, simulated.map, index_of(simulated.map));
  ASSERT_TRUE(found);
  EXPECT_LT((found->T_camera_world * yawed(10)).translation().norm(), 0.01);
}

TEST(Relocalizer, DoesNotFindAnUnknownPlace) {
  const SimulatedWorld world({}, simulated_camera());
  const SimulatedMap simulated = map_all_round(world);
  const SimulatedWorld elsewhere({.seed = 99}, simulated_camera());
  std::mt19937 rng(5);
  const Observed seen = elsewhere.observe(yawed(0), kNoise, rng);
  const Relocalizer relocalizer = make_relocalizer(world);
  for (std::uint32_t frame = 0; frame < 4; ++frame) {
    EXPECT_FALSE(
        relocalizer.find(FrameId(frame), seen.features, simulated.map, index_of(simulated.map)));
  }
}

TEST(Relocalizer, FeaturesWithoutDepthCount) {
  const SimulatedWorld world({}, simulated_camera());
  const SimulatedMap simulated = map_all_round(world);
  std::mt19937 rng(5);
  ObservationNoise far = kNoise;
  far.missing_depth_share = 0.9;
  const Observed seen = world.observe(yawed(10), far, rng);
  const std::optional<Relocalization> found = make_relocalizer(world).find(
      FrameId(0), seen.features, simulated.map, index_of(simulated.map));
  ASSERT_TRUE(found);
  EXPECT_LT((found->T_camera_world * yawed(10)).translation().norm(), 0.03);
  const auto with_depth = std::ranges::count_if(
      found->matches, [&](const auto& match) { return seen.features.depth_m[match.first] > 0; });
  EXPECT_GT(std::ssize(found->matches), 5 * with_depth);
}

TEST(Relocalizer, LooksForMoreWhereTheFirstMatchesSay) {
  const SimulatedWorld world({}, simulated_camera());
  const SimulatedMap simulated = map_all_round(world);
  std::mt19937 rng(5);
  const Observed seen = world.observe(yawed(15), kNoise, rng);
  const std::optional<Relocalization> found = make_relocalizer(world).find(
      FrameId(0), seen.features, simulated.map, index_of(simulated.map));
  ASSERT_TRUE(found);
  // No single key frame sees everything that the frame, half way between two, sees.
  std::size_t most = 0;
  for (const auto& [id, keyframe] : simulated.map.keyframes()) {
    std::size_t seen_by_it = 0;
    for (const auto& [feature, landmark] : found->matches) {
      seen_by_it += std::ranges::count(keyframe.landmarks, landmark);
    }
    most = std::max(most, seen_by_it);
  }
  EXPECT_GT(found->matches.size(), most + 30);
}

// A desk of the same make in another room: a part of the view matches a known place.
TEST(Relocalizer, DoesNotFindAPlaceThatHasLittleInCommonWithAKnownOne) {
  const SimulatedWorld world({}, simulated_camera());
  const SimulatedMap simulated = map_all_round(world);
  const SimulatedWorld elsewhere({.seed = 99}, simulated_camera());
  std::mt19937 rng(5);
  Features seen = elsewhere.observe(yawed(0), kNoise, rng).features;
  const Features known = world.observe(yawed(0), kNoise, rng).features;
  const std::size_t count = std::min(seen.size(), known.size());
  for (std::size_t i = 0; i < count; i += 6) {
    seen.px[i] = known.px[i];
    seen.depth_m[i] = known.depth_m[i];
    seen.level[i] = known.level[i];
    seen.angle_deg[i] = known.angle_deg[i];
    seen.descriptors[i] = known.descriptors[i];
  }
  seen.grid = FeatureGrid(seen.px, 640, 480);
  const auto find = [&](const RelocalizerConfig& config) {
    return make_relocalizer(world, config)
        .find(FrameId(0), seen, simulated.map, index_of(simulated.map));
  };
  EXPECT_TRUE(find({.min_share = 0}));
  EXPECT_FALSE(find({}));
}

TEST(Relocalizer, DoesNotFindKnownCornersInAnotherArrangement) {
  const SimulatedWorld world({}, simulated_camera());
  const SimulatedMap simulated = map_all_round(world);
  std::mt19937 rng(5);
  Observed seen = world.observe(yawed(0), kNoise, rng);
  std::ranges::shuffle(seen.features.px, rng);
  std::ranges::shuffle(seen.features.depth_m, rng);
  EXPECT_FALSE(make_relocalizer(world).find(
      FrameId(0), seen.features, simulated.map, index_of(simulated.map)));
}

TEST(Relocalizer, IsTheSameBitsForASeed) {
  const SimulatedWorld world({}, simulated_camera());
  const SimulatedMap simulated = map_all_round(world);
  std::mt19937 rng(5);
  const Observed seen = world.observe(yawed(10), kNoise, rng);
  const auto find = [&](std::uint32_t seed) {
    return make_relocalizer(world, {.iterations = 5}, seed)
        .find(FrameId(3), seen.features, simulated.map, index_of(simulated.map));
  };
  const std::optional<Relocalization> first = find(7), second = find(7);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->T_camera_world.matrix(), second->T_camera_world.matrix());
  EXPECT_EQ(first->matches, second->matches);
  bool seed_matters = false;
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const std::optional<Relocalization> other = find(seed);
    seed_matters =
        seed_matters || !other || other->T_camera_world.matrix() != first->T_camera_world.matrix();
  }
  EXPECT_TRUE(seed_matters);
}

// Places that share no landmarks: key frame k is at the origin of the k-th world.
struct Places {
  std::vector<SimulatedWorld> worlds;
  SimulatedMap map;
};

Places separate_places(std::uint32_t count) {
  Places places{{}, SimulatedMap(SimulatedWorld({}, simulated_camera()))};
  std::mt19937 rng(6);
  for (std::uint32_t k = 0; k < count; ++k) {
    places.worlds.emplace_back(SimulatedWorld::Config{.points = 2000, .seed = 100 + k},
                               simulated_camera());
    const SimulatedWorld& world = places.worlds.back();
    const KeyframeId id =
        add_bare_keyframe(places.map, yawed(0), world.observe(yawed(0), kNoise, rng));
    const std::vector<std::uint32_t>& points = places.map.points[k];
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      places.map.map.add_landmark(world.points()[points[i]].position, {id, i});
    }
  }
  return places;
}

TEST(Relocalizer, TriesTheKeyframesThatLookMostLikeIt) {
  const Places places = separate_places(20);
  const PlaceIndex index = index_of(places.map.map);
  std::mt19937 rng(7);
  const Relocalizer relocalizer = make_relocalizer(places.worlds[0], {.candidates = 1});
  for (std::size_t k = 0; k < places.worlds.size(); ++k) {
    const Observed seen = places.worlds[k].observe(yawed(3), kNoise, rng);
    EXPECT_TRUE(relocalizer.find(FrameId(0), seen.features, places.map.map, index)) << k;
  }
}

}  // namespace
}  // namespace stillmap
