// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulated_round.hpp"

#include <numbers>

namespace stillmap {
namespace {

void forget_old_landmarks(SimulatedMap& simulated, std::uint32_t k) {
  std::erase_if(simulated.landmark_of_point, [&](const auto& known) {
    const Landmark& landmark = simulated.map.landmark(known.second);
    return landmark.observations.back().keyframe.value + 5 < k;
  });
}

// The drift of each key frame's tracked pose against its true pose, by left multiplication.
std::vector<Eigen::Isometry3d> motions_of(const RoundSpec& spec) {
  std::vector<Eigen::Isometry3d> motions;
  Eigen::Isometry3d drift = Eigen::Isometry3d::Identity();
  for (std::uint32_t k = 0; k < spec.keyframes; ++k) {
    const bool second = spec.second_submap_from && k >= *spec.second_submap_from;
    motions.push_back(second ? spec.T_second_first * drift : drift);
    drift = perturb_left(drift, spec.drift);
  }
  return motions;
}

}  // namespace

Eigen::Isometry3d round_pose(std::uint32_t k) {
  const double angle = 2 * std::numbers::pi * k / kRoundKeyframes;
  return make_pose(so3_exp(Eigen::Vector3d(0, angle, 0)),
                   0.6 * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle)));
}

SimulatedMap drifted_round(const SimulatedWorld& world, const RoundSpec& spec) {
  std::mt19937 rng(1);
  SimulatedMap simulated(world);
  for (std::uint32_t k = 0; k < spec.keyframes; ++k) {
    forget_old_landmarks(simulated, k);
    if (k == spec.second_submap_from) {
      simulated.current_world = SubmapId(1);
      simulated.landmark_of_point.clear();
    }
    const Eigen::Isometry3d pose = round_pose(k);
    add_true_keyframe(simulated, world, pose, world.observe(pose, spec.noise, rng));
  }
  Map& map = simulated.map;
  const std::vector<Eigen::Isometry3d> motions = motions_of(spec);
  for (std::uint32_t k = 0; k < spec.keyframes; ++k) {
    map.set_pose(KeyframeId(k), motions[k] * round_pose(k));
  }
  for (const LandmarkId id : map.landmark_ids()) {
    const Landmark& landmark = map.landmark(id);
    map.set_position(id, motions[landmark.created_by.index()] * landmark.p_world);
    map.refresh(id);
  }
  (void)map.take_changes();
  return simulated;
}

double mean_error_m(const SimulatedMap& simulated) {
  double sum = 0;
  for (const auto& [id, keyframe] : simulated.map.keyframes()) {
    const Eigen::Isometry3d& truth = simulated.T_world_keyframe[id.index()];
    sum += (keyframe.T_world_camera.translation() - truth.translation()).norm();
  }
  return sum / static_cast<double>(simulated.map.keyframes().size());
}

}  // namespace stillmap
