// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/mapping/landmark_fusion.hpp"

#include <set>

#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"
#include "tests/support/simulated_map.hpp"

namespace stillmap {
namespace {

const LandmarkFusionConfig kFusion{.radius_px = 6};

MeasurementModel model(const SimulatedWorld& world) {
  return MeasurementModel({.pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.01},
                          world.level_scales());
}

Eigen::Isometry3d shifted(double x) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, 0.2 * x, 0));
}

// Key frames 0.1 m apart, each with landmarks of its own: every point is there many times.
SimulatedMap duplicated(const SimulatedWorld& world, int keyframes, double landmark_sigma_m) {
  SimulatedMap simulated(world);
  std::mt19937 rng(1);
  std::normal_distribution<double> normal(0, landmark_sigma_m);
  for (int k = 0; k < keyframes; ++k) {
    const Eigen::Isometry3d pose = shifted(0.1 * k);
    const KeyframeId id = add_bare_keyframe(
        simulated, pose, world.observe(pose, {.pixel_sigma_px = 0.3, .flipped_bits = 10}, rng));
    const std::vector<std::uint32_t>& points = simulated.points[id.index()];
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d off(normal(rng), normal(rng), normal(rng));
      simulated.map.add_landmark(world.points()[points[i]].position + off, {id, i});
    }
  }
  return simulated;
}

std::vector<LandmarkId> seen_by(const Map& map, std::uint32_t keyframe) {
  std::vector<LandmarkId> ids;
  for (const LandmarkId id : map.keyframe(KeyframeId(keyframe)).landmarks) {
    if (id.valid()) ids.push_back(id);
  }
  return ids;
}

int points_in_both(const SimulatedMap& simulated) {
  const std::set<std::uint32_t> first(simulated.points[0].begin(), simulated.points[0].end());
  int both = 0;
  for (const std::uint32_t point : simulated.points[1]) both += first.contains(point) ? 1 : 0;
  return both;
}

// Every landmark is seen as one true point only.
void expect_pure(const SimulatedMap& simulated) {
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    std::set<std::uint32_t> points;
    for (const Observation& o : simulated.map.landmark(id).observations) {
      points.insert(simulated.points[o.keyframe.index()][o.feature]);
    }
    EXPECT_EQ(points.size(), 1U) << id.value;
  }
  simulated.map.check_consistency();
}

TEST(FuseLandmarks, MergesDuplicates) {
  const SimulatedWorld world({}, simulated_camera());
  SimulatedMap simulated = duplicated(world, 2, 0.002);
  const std::size_t before = simulated.map.landmark_count();
  const int both = points_in_both(simulated);
  const int found = fuse_landmarks(simulated.map,
                                   KeyframeId(1),
                                   seen_by(simulated.map, 0),
                                   world.camera(),
                                   model(world),
                                   kFusion);
  EXPECT_GT(found, 0.9 * both);  // noise moves a few beyond the 95 % bound
  EXPECT_LE(found, both);
  EXPECT_EQ(simulated.map.landmark_count(), before - static_cast<std::size_t>(found));
  expect_pure(simulated);
}

TEST(FuseLandmarks, GivesFreeFeaturesTheirLandmarks) {
  const SimulatedWorld world({}, simulated_camera());
  SimulatedMap simulated = duplicated(world, 2, 0.002);
  for (const LandmarkId id : seen_by(simulated.map, 1)) simulated.map.remove_landmark(id);
  const std::vector<LandmarkId> known = simulated.map.landmark_ids();
  const int found =
      fuse_landmarks(simulated.map, KeyframeId(1), known, world.camera(), model(world), kFusion);
  EXPECT_GT(found, 0.9 * points_in_both(simulated));
  EXPECT_EQ(simulated.map.landmark_ids(), known);
  EXPECT_EQ(seen_by(simulated.map, 1).size(), static_cast<std::size_t>(found));
  expect_pure(simulated);
}

TEST(FuseLandmarks, KeepsTheOneThatMoreKeyframesSee) {
  const SimulatedWorld world({}, simulated_camera());
  SimulatedMap simulated = duplicated(world, 3, 0);
  const auto fuse_into = [&](std::uint32_t keyframe, std::uint32_t of) {
    fuse_landmarks(simulated.map,
                   KeyframeId(keyframe),
                   seen_by(simulated.map, of),
                   world.camera(),
                   model(world),
                   kFusion);
  };
  fuse_into(1, 0);
  const std::vector<LandmarkId> shared = seen_by(simulated.map, 1);
  fuse_into(2, 1);  // 2 key frames see each of `shared`, one each of the third's
  int kept = 0;
  for (const LandmarkId id : seen_by(simulated.map, 2)) {
    const Landmark& landmark = simulated.map.landmark(id);
    if (landmark.observations.size() < 3) continue;
    ++kept;
    EXPECT_NE(landmark.created_by, KeyframeId(2));
  }
  EXPECT_GT(kept, 100);
  expect_pure(simulated);
}

TEST(FuseLandmarks, DoesNotMergeNeighborsThatLookAlike) {
  // 60 kinds of corners for 5000 points: dozens in view look like each, some of them close by.
  const SimulatedWorld world({.kinds = 60}, simulated_camera());
  SimulatedMap simulated = duplicated(world, 2, 0.002);
  const int found = fuse_landmarks(simulated.map,
                                   KeyframeId(1),
                                   seen_by(simulated.map, 0),
                                   world.camera(),
                                   model(world),
                                   kFusion);
  EXPECT_GT(found, 0.85 * points_in_both(simulated));
  int mixed = 0;
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    const std::vector<Observation>& seen = simulated.map.landmark(id).observations;
    const auto point = [&](const Observation& o) {
      return simulated.points[o.keyframe.index()][o.feature];
    };
    mixed += seen.size() == 2 && point(seen[0]) != point(seen[1]) ? 1 : 0;
  }
  EXPECT_EQ(mixed, 0);
}

TEST(FuseLandmarks, LeavesWhatItsProjectionContradicts) {
  const SimulatedWorld world({}, simulated_camera());
  SimulatedMap simulated = duplicated(world, 2, 0);
  // 5 cm off is 10 pixels and more at the distances of the box.
  for (const LandmarkId id : seen_by(simulated.map, 0)) {
    simulated.map.set_position(id,
                               simulated.map.landmark(id).p_world + Eigen::Vector3d(0.05, 0, 0));
  }
  const int found = fuse_landmarks(simulated.map,
                                   KeyframeId(1),
                                   seen_by(simulated.map, 0),
                                   world.camera(),
                                   model(world),
                                   kFusion);
  EXPECT_EQ(found, 0);
}

TEST(FuseLandmarks, LeavesFeaturesOfLandmarksOutsideTheWindow) {
  const SimulatedWorld world({}, simulated_camera());
  SimulatedMap simulated = duplicated(world, 2, 0);
  // One landmark that both see brings key frame 1 into the window of key frame 0; what else it
  // sees is outside.
  fuse_landmarks(simulated.map,
                 KeyframeId(1),
                 std::vector(1, seen_by(simulated.map, 0)[150]),
                 world.camera(),
                 model(world),
                 kFusion);
  Map window = simulated.map.window(std::vector{KeyframeId(0)});
  ASSERT_TRUE(window.has(KeyframeId(1)));
  const std::vector<LandmarkId> before = window.keyframe(KeyframeId(1)).landmarks;
  const int found = fuse_landmarks(
      window, KeyframeId(1), seen_by(window, 0), world.camera(), model(world), kFusion);
  EXPECT_EQ(found, 0);
  EXPECT_EQ(window.keyframe(KeyframeId(1)).landmarks, before);
}

}  // namespace
}  // namespace stillmap
