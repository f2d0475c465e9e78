// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/loop/essential_graph.hpp"

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/slam/map/covisibility.hpp"
#include "tests/support/simulated_map.hpp"

namespace stillmap {
namespace {

constexpr std::uint32_t kCount = 24;

// Key frames all round, 15 degrees apart.
std::vector<Eigen::Isometry3d> round_poses() {
  std::vector<Eigen::Isometry3d> poses;
  for (std::uint32_t k = 0; k < kCount; ++k) {
    const double angle = 2 * std::numbers::pi * k / kCount;
    poses.push_back(make_pose(so3_exp(Eigen::Vector3d(0, angle, 0)),
                              0.5 * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle))));
  }
  return poses;
}

// A map whose last key frames do not know what the first see, and which has drifted: each pose off
// from the one before, landmarks with those that made them.
struct Drifted {
  SimulatedMap simulated;
  std::map<LandmarkId, Eigen::Vector3d> true_positions;
};

Drifted drifted_map(const SimulatedWorld& world) {
  std::mt19937 rng(1);
  Drifted drifted{SimulatedMap(world), {}};
  SimulatedMap& simulated = drifted.simulated;
  const std::vector<Eigen::Isometry3d> poses = round_poses();
  for (std::uint32_t k = 0; k < kCount; ++k) {
    if (k == kCount / 2) simulated.landmark_of_point.clear();  // nothing old is known again
    if (k == kCount / 2) {
      // except by the key frame at the seam, which keeps the map in one piece
      for (std::uint32_t i = 0; i < simulated.points[k - 1].size(); ++i) {
        simulated.landmark_of_point[simulated.points[k - 1][i]] =
            simulated.map.keyframe(KeyframeId(k - 1)).landmarks[i];
      }
    }
    add_true_keyframe(simulated, world, poses[k], world.observe(poses[k], {}, rng));
  }
  Map& map = simulated.map;
  for (const LandmarkId id : map.landmark_ids()) {
    drifted.true_positions[id] = map.landmark(id).p_world;
  }
  std::map<KeyframeId, Eigen::Isometry3d> moved;
  Eigen::Isometry3d drift = Eigen::Isometry3d::Identity();
  for (std::uint32_t k = 0; k < kCount; ++k) {
    moved[KeyframeId(k)] = drift * poses[k];
    drift = perturb_left(drift, (Vector6d() << 0.01, 0, 0.004, 0, 0.006, 0.001).finished());
  }
  move_keyframes(map, moved);
  return drifted;
}

double worst_position(const Map& map) {
  const std::vector<Eigen::Isometry3d> truth = round_poses();
  double worst = 0;
  for (const auto& [id, keyframe] : map.keyframes()) {
    worst = std::max(
        worst, (keyframe.T_world_camera.translation() - truth[id.index()].translation()).norm());
  }
  return worst;
}

TEST(EssentialGraph, HasATreeAndThePairsThatShareMuch) {
  const SimulatedWorld world({}, simulated_camera());
  std::mt19937 rng(2);
  const SimulatedMap simulated = make_true_map(world, round_poses(), {}, rng);
  const EssentialGraph tree =
      essential_graph(simulated.map, SubmapId(0), {}, {.min_shared = 100000});
  EXPECT_EQ(tree.keyframes.size(), kCount);
  EXPECT_EQ(tree.graph.edges.size(), kCount - 1);
  // All that share 60 or more, counted one by one.
  std::size_t strong = 0;
  for (const auto& [id, keyframe] : simulated.map.keyframes()) {
    for (const CovisibleKeyframe& other : covisible_keyframes(simulated.map, id)) {
      strong += id < other.id && other.shared_landmarks >= 60 ? 1 : 0;
    }
  }
  ASSERT_GT(strong, kCount - 1);
  const EssentialGraph essential =
      essential_graph(simulated.map, SubmapId(0), {}, {.min_shared = 60});
  EXPECT_GE(essential.graph.edges.size(), strong);
  EXPECT_LT(essential.graph.edges.size(), strong + kCount);
  for (const PoseGraphEdge& edge : essential.graph.edges) {
    EXPECT_LT(edge.from, edge.to);
    const Eigen::Isometry3d now =
        essential.graph.T_world[edge.from].inverse() * essential.graph.T_world[edge.to];
    EXPECT_EQ(edge.T_from_to.matrix(), now.matrix());
  }
}

TEST(EssentialGraph, KeyframesThatShareNothingFollowTheOneBefore) {
  Map map({1.0F});
  for (int k = 0; k < 4; ++k) {
    Keyframe keyframe;
    keyframe.features = std::make_shared<const Features>();
    keyframe.T_world_camera.translation().x() = k;
    map.add_keyframe(std::move(keyframe));
  }
  map.remove_keyframe(KeyframeId(1), KeyframeId(0));
  const std::vector<LoopEdge> loops = {
      {KeyframeId(0), KeyframeId(3), Eigen::Isometry3d::Identity(), 0.001, 0.01},
      {KeyframeId(1), KeyframeId(3)},  // gone
  };
  const EssentialGraph essential = essential_graph(map, SubmapId(0), loops, {});
  ASSERT_EQ(essential.graph.edges.size(), 3U);
  EXPECT_EQ(essential.graph.edges[0].to, 1U);  // places, not ids
  EXPECT_EQ(essential.graph.edges[1].to, 2U);
  EXPECT_EQ(essential.graph.edges[2].from, 0U);
  EXPECT_EQ(essential.loop_edges, std::vector<std::uint32_t>{2});
  EXPECT_EQ(essential.graph.edges[2].sigma_m, 0.005);  // at least
  EXPECT_EQ(essential.graph.edges[2].sigma_rad, 0.03);
  EXPECT_EQ(essential.graph.held, (std::vector<std::uint8_t>{1, 0, 0}));
}

TEST(EssentialGraph, ALoopBringsADriftedMapBack) {
  const SimulatedWorld world({}, simulated_camera());
  Drifted drifted = drifted_map(world);
  Map& map = drifted.simulated.map;
  const std::vector<Eigen::Isometry3d> truth = round_poses();
  const double before = worst_position(map);
  const LoopEdge loop{
      KeyframeId(0), KeyframeId(kCount - 1), truth[0].inverse() * truth[kCount - 1]};
  const EssentialGraph essential = essential_graph(map, SubmapId(0), std::span(&loop, 1), {});
  const PoseGraphResult result = optimize_pose_graph(essential.graph, {});
  std::map<KeyframeId, Eigen::Isometry3d> moved;
  for (std::size_t i = 0; i < essential.keyframes.size(); ++i) {
    moved[essential.keyframes[i]] = result.T_world[i];
  }
  move_keyframes(map, moved);
  map.check_consistency();
  EXPECT_GT(before, 0.1);
  EXPECT_LT(worst_position(map), before / 3);
  // Landmarks came along.
  double landmark_error = 0;
  for (const auto& [id, p_true] : drifted.true_positions) {
    landmark_error += (map.landmark(id).p_world - p_true).norm();
  }
  EXPECT_LT(landmark_error / static_cast<double>(drifted.true_positions.size()), 0.1);
}

TEST(EssentialGraph, LandmarksKeepTheirPlaceBeforeTheKeyframeThatMadeThem) {
  const SimulatedWorld world({.points = 500}, simulated_camera());
  std::mt19937 rng(3);
  SimulatedMap simulated = make_true_map(world, round_poses(), {}, rng);
  Map& map = simulated.map;
  std::map<LandmarkId, Eigen::Vector3d> seen;
  for (const LandmarkId id : map.landmark_ids()) {
    const Landmark& landmark = map.landmark(id);
    seen[id] = map.T_world_keyframe(landmark.created_by).inverse() * landmark.p_world;
  }
  std::map<KeyframeId, Eigen::Isometry3d> moved;
  for (const auto& [id, keyframe] : map.keyframes()) {
    moved[id] = perturb_left(keyframe.T_world_camera, Vector6d::Constant(0.01 * id.value));
  }
  move_keyframes(map, moved);
  for (const auto& [id, p_keyframe] : seen) {
    const Landmark& landmark = map.landmark(id);
    const Eigen::Vector3d now =
        map.T_world_keyframe(landmark.created_by).inverse() * landmark.p_world;
    EXPECT_LT((now - p_keyframe).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace stillmap
