// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulated_map.hpp"

#include <algorithm>
#include <utility>

namespace stillmap {

KeyframeId add_bare_keyframe(SimulatedMap& simulated,
                             const Eigen::Isometry3d& T_world_camera,
                             Observed observed) {
  Keyframe keyframe;
  keyframe.frame = FrameId(static_cast<std::uint32_t>(simulated.points.size()));
  keyframe.submap = simulated.current_world;
  keyframe.T_world_camera = T_world_camera;
  keyframe.features = std::make_shared<const Features>(std::move(observed.features));
  simulated.T_world_keyframe.push_back(T_world_camera);
  simulated.points.push_back(std::move(observed.points));
  return simulated.map.add_keyframe(std::move(keyframe));
}

KeyframeId add_true_keyframe(SimulatedMap& simulated,
                             const SimulatedWorld& world,
                             const Eigen::Isometry3d& T_world_camera,
                             Observed observed) {
  const KeyframeId id = add_bare_keyframe(simulated, T_world_camera, std::move(observed));
  const std::vector<std::uint32_t>& points = simulated.points[id.index()];
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto known = simulated.landmark_of_point.find(points[i]);
    if (known == simulated.landmark_of_point.end()) {
      simulated.landmark_of_point[points[i]] =
          simulated.map.add_landmark(world.points()[points[i]].position, {id, i});
    } else {
      simulated.map.add_observation(known->second, {id, i});
      simulated.map.refresh(known->second);
    }
  }
  return id;
}

SimulatedMap make_true_map(const SimulatedWorld& world,
                           std::span<const Eigen::Isometry3d> poses,
                           const ObservationNoise& noise,
                           std::mt19937& rng) {
  SimulatedMap simulated(world);
  for (const Eigen::Isometry3d& pose : poses) {
    add_true_keyframe(simulated, world, pose, world.observe(pose, noise, rng));
  }
  return simulated;
}

std::uint32_t true_point(const SimulatedMap& simulated, const Landmark& landmark) {
  std::map<std::uint32_t, int> votes;
  for (const Observation& o : landmark.observations) {
    ++votes[simulated.points[o.keyframe.index()][o.feature]];
  }
  const auto by_votes = [](const auto& a, const auto& b) { return a.second < b.second; };
  return std::ranges::max_element(votes, by_votes)->first;
}

}  // namespace stillmap
