// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <vector>

#include "stillmap/slam/map/map.hpp"
#include "tests/support/simulated_world.hpp"

namespace stillmap {

/// A map of a simulated world with its truth. Key frame k is at the k-th added pose.
struct SimulatedMap {
  Map map;
  std::vector<Eigen::Isometry3d> T_world_keyframe;        ///< true poses
  std::vector<std::vector<std::uint32_t>> points;         ///< per key frame and feature
  std::map<std::uint32_t, LandmarkId> landmark_of_point;  ///< as made; merged ones stay
  SubmapId current_world{0};                              ///< submap of the next key frames

  explicit SimulatedMap(const SimulatedWorld& world) : map(world.level_scales()) {}
};

/// Adds a key frame that sees no landmarks yet, at its true pose.
KeyframeId add_bare_keyframe(SimulatedMap& simulated,
                             const Eigen::Isometry3d& T_world_camera,
                             Observed observed);

/// Adds a key frame at its true pose whose features see the world's true points: known landmarks
/// are observed again, others are made.
KeyframeId add_true_keyframe(SimulatedMap& simulated,
                             const SimulatedWorld& world,
                             const Eigen::Isometry3d& T_world_camera,
                             Observed observed);

/// A map of true key frames at all `poses`.
[[nodiscard]] SimulatedMap make_true_map(const SimulatedWorld& world,
                                         std::span<const Eigen::Isometry3d> poses,
                                         const ObservationNoise& noise,
                                         std::mt19937& rng);

/// The world's point that most observations of the landmark show.
[[nodiscard]] std::uint32_t true_point(const SimulatedMap& simulated, const Landmark& landmark);

}  // namespace stillmap
