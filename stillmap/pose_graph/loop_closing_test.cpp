// SPDX-License-Identifier: Apache-2.0
// The parts of loop closing together, on a simulated map: candidates, gate, geometry, pose graph.
#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "stillmap/core/se3.hpp"
#include "stillmap/loop/loop_gate.hpp"
#include "stillmap/loop/loop_verifier.hpp"
#include "stillmap/map/covisibility.hpp"
#include "stillmap/place/place_index.hpp"
#include "stillmap/pose_graph/essential_graph.hpp"
#include "stillmap/testing/simulated_map.hpp"

namespace stillmap {
namespace {

constexpr std::uint32_t kRound = 40;          // key frames of one round, 9 degrees apart
constexpr std::uint32_t kCount = kRound + 4;  // the last four see again what the first saw

std::vector<Eigen::Isometry3d> true_poses() {
  std::vector<Eigen::Isometry3d> poses;
  for (std::uint32_t k = 0; k < kCount; ++k) {
    const double angle = 2 * std::numbers::pi * k / kRound;
    poses.push_back(make_pose(so3_exp(Eigen::Vector3d(0, angle, 0)),
                              0.6 * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle))));
  }
  return poses;
}

// What tracking without loops makes of it: each key frame knows what the five before it saw, no
// landmark older than that, and stands a little off from where it should.
SimulatedMap drifted_map(const SimulatedWorld& world) {
  const ObservationNoise noise{.pixel_sigma_px = 0.5,
                               .inverse_depth_sigma = 0.004,
                               .wrong_descriptor_share = 0.2,
                               .flipped_bits = 10};
  std::mt19937 rng(1);
  SimulatedMap simulated(world);
  const std::vector<Eigen::Isometry3d> poses = true_poses();
  for (std::uint32_t k = 0; k < kCount; ++k) {
    std::erase_if(simulated.landmark_of_point, [&](const auto& known) {
      const Landmark& landmark = simulated.map.landmark(known.second);
      return landmark.observations.back().keyframe.value + 5 < k;
    });
    add_true_keyframe(simulated, world, poses[k], world.observe(poses[k], noise, rng));
  }
  std::map<KeyframeId, Eigen::Isometry3d> drifted;
  Eigen::Isometry3d drift = Eigen::Isometry3d::Identity();
  for (std::uint32_t k = 0; k < kCount; ++k) {
    drifted[KeyframeId(k)] = drift * poses[k];
    drift = perturb_left(drift, (Vector6d() << 0.006, 0.001, 0.002, 0.0005, 0.003, 0).finished());
  }
  move_keyframes(simulated.map, drifted);
  return simulated;
}

double mean_error_m(const Map& map) {
  const std::vector<Eigen::Isometry3d> truth = true_poses();
  double sum = 0;
  for (const auto& [id, keyframe] : map.keyframes()) {
    sum += (keyframe.T_world_camera.translation() - truth[id.index()].translation()).norm();
  }
  return sum / static_cast<double>(map.keyframes().size());
}

std::vector<KeyframeId> neighbours(const Map& map, KeyframeId id) {
  std::vector<KeyframeId> ids;
  for (const CovisibleKeyframe& other : covisible_keyframes(map, id)) ids.push_back(other.id);
  return ids;
}

// As the system would: each key frame asks the index, then joins it.
std::vector<LoopEdge> find_loops(const Map& map, const SimulatedWorld& world) {
  const MeasurementModel measure({.pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.01},
                                 world.level_scales());
  const LoopVerifier verifier({}, world.camera(), measure, 0);
  PlaceIndex index;
  LoopGate gate({});
  std::vector<LoopEdge> loops;
  for (const auto& [id, keyframe] : map.keyframes()) {
    std::vector<GateCandidate> candidates;
    for (const PlaceCandidate& found :
         index.query(keyframe.features->descriptors, 3, neighbours(map, id))) {
      candidates.push_back({found.keyframe, neighbours(map, found.keyframe)});
    }
    for (const KeyframeId candidate : gate.advance(candidates)) {
      const std::optional<VerifiedLoop> loop =
          verifier.verify(FrameId(id.value),
                          loop_view(map.keyframe(candidate), map, world.camera(), measure),
                          loop_view(keyframe, map, world.camera(), measure));
      if (loop) loops.push_back({candidate, id, loop->T_a_b, loop->sigma_m, loop->sigma_rad});
    }
    index.add(id, keyframe.features->descriptors);
  }
  return loops;
}

TEST(LoopClosing, TheEndOfARoundFindsItsBeginningAndTheDriftGoes) {
  const SimulatedWorld world({}, simulated_camera());
  SimulatedMap simulated = drifted_map(world);
  Map& map = simulated.map;
  const std::vector<Eigen::Isometry3d> truth = true_poses();
  const std::vector<LoopEdge> loops = find_loops(map, world);
  ASSERT_FALSE(loops.empty());
  for (const LoopEdge& loop : loops) {
    EXPECT_GE(loop.b.value, loop.a.value + kRound - 5);
    const Eigen::Isometry3d T_a_b = truth[loop.a.index()].inverse() * truth[loop.b.index()];
    EXPECT_LT((loop.T_a_b.inverse() * T_a_b).translation().norm(), 0.02);
  }
  const EssentialGraph essential = essential_graph(map, WorldId(0), loops, {});
  const PoseGraphResult result = optimize_pose_graph(essential.graph, {});
  std::map<KeyframeId, Eigen::Isometry3d> moved;
  for (std::size_t i = 0; i < essential.keyframes.size(); ++i) {
    moved[essential.keyframes[i]] = result.T_world[i];
  }
  const double before = mean_error_m(map);
  move_keyframes(map, moved);
  map.check_consistency();
  EXPECT_GT(before, 0.08);
  EXPECT_LT(mean_error_m(map), before / 3);
  for (const std::uint32_t edge : essential.loop_edges) EXPECT_LT(result.chi2[edge], 50);
}

}  // namespace
}  // namespace stillmap
