// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/loop/loop_verifier.hpp"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/support/simulated_map.hpp"

namespace stillmap {
namespace {

constexpr ObservationNoise kNoise{.pixel_sigma_px = 0.7,
                                  .inverse_depth_sigma = 0.01,
                                  .missing_depth_share = 0.1,
                                  .wrong_descriptor_share = 0.3,
                                  .flipped_bits = 15};

Eigen::Isometry3d pose(double yaw_deg, const Eigen::Vector3d& position) {
  return make_pose(so3_exp(Eigen::Vector3d(0, yaw_deg * 3.14159265358979 / 180, 0)), position);
}

MeasurementModel measure_of(const SimulatedWorld& world) {
  return MeasurementModel({.pixel_sigma_px = 0.7, .inverse_depth_sigma = 0.01},
                          world.level_scales());
}

// From depth alone, as a key frame without landmarks.
LoopView view_of(const SimulatedWorld& world, const Observed& seen) {
  Keyframe keyframe;
  keyframe.features = std::make_shared<const Features>(seen.features);
  keyframe.landmarks.resize(seen.features.size());
  return loop_view(keyframe, Map(world.level_scales()), world.camera(), measure_of(world));
}

LoopVerifier verifier_of(const SimulatedWorld& world,
                         const LoopVerifierConfig& config = {},
                         std::uint32_t seed = 0) {
  return LoopVerifier(config, world.camera(), measure_of(world), seed);
}

TEST(LoopVerifier, FindsHowTheViewsStandToEachOther) {
  const SimulatedWorld world({}, simulated_camera());
  std::mt19937 rng(1);
  for (const double turn_deg : {0.0, 10.0, 25.0}) {
    const Eigen::Isometry3d T_world_a = pose(40, {0, 0, 0});
    const Eigen::Isometry3d T_world_b = pose(40 + turn_deg, {0.2, -0.1, 0.15});
    const Observed seen_a = world.observe(T_world_a, kNoise, rng);
    const Observed seen_b = world.observe(T_world_b, kNoise, rng);
    const std::optional<LoopMatch> loop =
        verifier_of(world).verify(FrameId(5), view_of(world, seen_a), view_of(world, seen_b));
    ASSERT_TRUE(loop) << turn_deg;
    const Eigen::Isometry3d error = loop->edge.T_a_b.inverse() * (T_world_a.inverse() * T_world_b);
    EXPECT_LT(error.translation().norm(), 0.02) << turn_deg;
    EXPECT_LT(rotation_angle(error.linear()), 0.004) << turn_deg;
    int right = 0;
    for (const auto& [in_a, in_b] : loop->matches) {
      right += seen_a.points[in_a] == seen_b.points[in_b] ? 1 : 0;
    }
    EXPECT_GE(right, 0.97 * static_cast<double>(loop->matches.size()));
    // Guided matching finds nearly all that both see with a right descriptor (about 0.7^2).
    EXPECT_GT(loop->share(), 0.3);
  }
}

// The two views must not be of the same noise: what it is worth to refine.
TEST(LoopVerifier, ExactViewsGiveTheExactPose) {
  const SimulatedWorld world({}, simulated_camera());
  std::mt19937 rng(2);
  const Eigen::Isometry3d T_world_a = pose(0, {0, 0, 0}), T_world_b = pose(12, {0.3, 0, 0});
  const std::optional<LoopMatch> loop =
      verifier_of(world).verify(FrameId(0),
                                view_of(world, world.observe(T_world_a, {}, rng)),
                                view_of(world, world.observe(T_world_b, {}, rng)));
  ASSERT_TRUE(loop);
  const Eigen::Isometry3d error = loop->edge.T_a_b.inverse() * (T_world_a.inverse() * T_world_b);
  EXPECT_LT(error.translation().norm(), 1e-4);  // pixels and depths are kept as floats
  EXPECT_LT(rotation_angle(error.linear()), 1e-4);
}

TEST(LoopVerifier, FindsItAmongManyWrongMatches) {
  const SimulatedWorld world({}, simulated_camera());
  std::mt19937 rng(3);
  const Eigen::Isometry3d T_world_a = pose(0, {0, 0, 0}), T_world_b = pose(8, {0.1, 0, 0.1});
  const Observed seen_a = world.observe(T_world_a, kNoise, rng);
  Observed seen_b = world.observe(T_world_b, kNoise, rng);
  // Half of the features look like another feature.
  for (std::size_t i = 2; i < seen_b.features.size(); i += 2) {
    std::swap(seen_b.features.descriptors[i], seen_b.features.descriptors[i - 2]);
    seen_b.features.angle_deg[i] = seen_b.features.angle_deg[i - 2];
  }
  const std::optional<LoopMatch> loop =
      verifier_of(world, {.min_share = 0.1})
          .verify(FrameId(0), view_of(world, seen_a), view_of(world, seen_b));
  ASSERT_TRUE(loop);
  const Eigen::Isometry3d error = loop->edge.T_a_b.inverse() * (T_world_a.inverse() * T_world_b);
  EXPECT_LT(error.translation().norm(), 0.02);
}

TEST(LoopVerifier, UsesLandmarksWhereThereAreAny) {
  const SimulatedWorld world({}, simulated_camera());
  std::mt19937 rng(4);
  const std::vector<Eigen::Isometry3d> poses = {pose(0, {0, 0, 0}), pose(5, {0.1, 0, 0})};
  SimulatedMap simulated = make_true_map(world, poses, {}, rng);
  const Keyframe& keyframe = simulated.map.keyframe(KeyframeId(1));
  const LandmarkId moved = keyframe.landmarks[3];
  const Eigen::Vector3d p_world(1, 2, 3);
  simulated.map.set_position(moved, p_world);
  const LoopView view = loop_view(
      simulated.map.keyframe(KeyframeId(1)), simulated.map, world.camera(), measure_of(world));
  ASSERT_TRUE(view.p_camera[3]);
  EXPECT_LT((*view.p_camera[3] - poses[1].inverse() * p_world).norm(), 1e-12);
}

// Statistics over different places whose corners are drawn from a few kinds, as those of one office
// are: much looks alike, nothing is in the same place.
TEST(LoopVerifier, RefusesDifferentPlaces) {
  int accepted_different = 0, accepted_same = 0;
  constexpr std::uint32_t kPlaces = 12;
  const SimulatedWorld::Config config{.points = 2000, .kinds = 400};
  std::vector<SimulatedWorld> worlds;
  for (std::uint32_t k = 0; k < kPlaces; ++k) {
    SimulatedWorld::Config other = config;
    other.seed = 50 + k;
    worlds.emplace_back(other, simulated_camera());
  }
  std::mt19937 rng(5);
  ObservationNoise noise = kNoise;
  noise.wrong_descriptor_share = 0.1;
  std::vector<LoopView> views, again;
  for (std::uint32_t k = 0; k < kPlaces; ++k) {
    Observed first = worlds[k].observe(pose(0, {0, 0, 0}), noise, rng);
    Observed second = worlds[k].observe(pose(6, {0.1, 0, 0}), noise, rng);
    // The kinds are the same in all places.
    for (Observed* seen : {&first, &second}) {
      for (std::size_t i = 0; i < seen->points.size(); ++i) {
        const std::uint32_t kind = seen->points[i] % 400U;
        std::mt19937 flips(static_cast<std::uint32_t>(rng()));
        Descriptor d = worlds[0].points()[kind].descriptor;
        for (int f = 0; f < 15; ++f) d[flips() % 4U] ^= std::uint64_t{1} << (flips() % 64U);
        if (flips() % 10U != 0) seen->features.descriptors[i] = d;
        seen->features.angle_deg[i] = worlds[0].points()[kind].angle_deg;
      }
    }
    views.push_back(view_of(worlds[k], first));
    again.push_back(view_of(worlds[k], second));
  }
  std::vector<std::uint32_t> all(views[0].features->size());
  std::iota(all.begin(), all.end(), 0U);
  ASSERT_GT(match_all(*views[0].features, all, *again[1].features, {60, 0.85}).size(), 50U);
  const LoopVerifier verifier = verifier_of(worlds[0], {.min_share = 0.1});
  for (std::uint32_t a = 0; a < kPlaces; ++a) {
    for (std::uint32_t b = 0; b < kPlaces; ++b) {
      const bool accepted = verifier.verify(FrameId(a), views[a], again[b]).has_value();
      (a == b ? accepted_same : accepted_different) += accepted ? 1 : 0;
    }
  }
  EXPECT_EQ(accepted_different, 0);
  EXPECT_GE(accepted_same, 10);
}

// A desk of many corners stands in two rooms that otherwise differ: seen from the same side, both
// images agree in it perfectly.
TEST(LoopVerifier, RefusesADeskOfTheSameMakeElsewhere) {
  const SimulatedWorld desk({.half_size_m = {1.0, 0.7, 1.4}, .points = 1500, .seed = 7},
                            simulated_camera());
  std::mt19937 rng(6);
  const auto scene = [&](std::uint32_t room_seed, const Eigen::Isometry3d& at) {
    const SimulatedWorld room({.seed = room_seed}, simulated_camera());
    Observed seen = room.observe(at, kNoise, rng);
    const Observed also = desk.observe(at, kNoise, rng);
    Features& f = seen.features;
    const auto append = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(f.raw_px, also.features.raw_px);
    append(f.ideal_px, also.features.ideal_px);
    append(f.sensor_depth_m, also.features.sensor_depth_m);
    append(f.px, also.features.px);
    append(f.depth_m, also.features.depth_m);
    append(f.level, also.features.level);
    append(f.angle_deg, also.features.angle_deg);
    append(f.descriptors, also.features.descriptors);
    f.grid = FeatureGrid(f.px, 640, 480);
    return std::pair(view_of(room, seen), also.features.size());
  };
  const auto [a, on_desk] = scene(20, pose(0, {0, 0, 0}));
  const auto [elsewhere, also_on_desk] = scene(21, pose(3, {0.05, 0, 0}));
  const auto [here, again_on_desk] = scene(20, pose(3, {0.05, 0, 0}));
  ASSERT_GT(on_desk, 80U);
  const LoopVerifier verifier = verifier_of(desk);
  EXPECT_FALSE(verifier.verify(FrameId(0), a, elsewhere));
  EXPECT_TRUE(verifier.verify(FrameId(0), a, here));
  // It is the share that tells.
  const std::optional<LoopMatch> fooled =
      verifier_of(desk, {.min_share = 0}).verify(FrameId(0), a, elsewhere);
  ASSERT_TRUE(fooled);
  EXPECT_LT(fooled->share(), 0.2);
}

TEST(LoopVerifier, RefusesEmptyAndPointlessViews) {
  const SimulatedWorld world({}, simulated_camera());
  std::mt19937 rng(7);
  const LoopView whole = view_of(world, world.observe(pose(0, {0, 0, 0}), {}, rng));
  const LoopView empty = view_of(world, {});
  LoopView flat = whole;
  flat.p_camera.assign(flat.p_camera.size(), std::nullopt);
  const LoopVerifier verifier = verifier_of(world);
  EXPECT_FALSE(verifier.verify(FrameId(0), empty, whole));
  EXPECT_FALSE(verifier.verify(FrameId(0), whole, empty));
  EXPECT_FALSE(verifier.verify(FrameId(0), flat, whole));
  EXPECT_FALSE(verifier.verify(FrameId(0), whole, flat));
}

TEST(LoopVerifier, IsTheSameBitsForASeed) {
  const SimulatedWorld world({}, simulated_camera());
  std::mt19937 rng(8);
  const LoopView a = view_of(world, world.observe(pose(0, {0, 0, 0}), kNoise, rng));
  const LoopView b = view_of(world, world.observe(pose(9, {0.1, 0, 0}), kNoise, rng));
  const std::optional<LoopMatch> first = verifier_of(world, {}, 3).verify(FrameId(9), a, b);
  const std::optional<LoopMatch> second = verifier_of(world, {}, 3).verify(FrameId(9), a, b);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->edge.T_a_b.matrix(), second->edge.T_a_b.matrix());
  EXPECT_EQ(first->matches, second->matches);
}

}  // namespace
}  // namespace stillmap
