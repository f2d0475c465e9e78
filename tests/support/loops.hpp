// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/slam/loop/loop_detector.hpp"
#include "tests/support/simulated_round.hpp"

// Shared by the tests of this module.
namespace stillmap {

[[nodiscard]] inline MeasurementModel loop_measure(const SimulatedWorld& world) {
  return MeasurementModel({.pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.01},
                          world.level_scales());
}

/// The loops that a detector finds for the first `keyframes` key frames, one after another. It is
/// told where tracking was lost, but of no closed loop.
[[nodiscard]] inline std::vector<LoopMatch> find_loops(const SimulatedMap& simulated,
                                                       const SimulatedWorld& world,
                                                       const LoopConfig& config = {},
                                                       std::uint32_t keyframes = 1000) {
  LoopDetector detector(config, world.camera(), loop_measure(world), 0);
  PlaceIndex places;
  std::vector<LoopMatch> loops;
  SubmapId current;
  for (const auto& [id, keyframe] : simulated.map.keyframes()) {
    if (id.value >= keyframes) break;
    if (keyframe.submap != current) detector.clear();
    current = keyframe.submap;
    places.add(id, keyframe.features->descriptors);
    std::optional<LoopMatch> found = detector.advance(simulated.map, places, id);
    if (found) loops.push_back(std::move(*found));
  }
  return loops;
}

/// The true relative pose of the later and the earlier key frame of a loop.
[[nodiscard]] inline Eigen::Isometry3d true_T_a_b(const SimulatedMap& simulated,
                                                  const LoopMatch& loop) {
  return simulated.T_world_keyframe[loop.edge.a.index()].inverse() *
         simulated.T_world_keyframe[loop.edge.b.index()];
}

/// Distance and angle between two poses.
[[nodiscard]] inline Eigen::Vector2d difference(const Eigen::Isometry3d& a,
                                                const Eigen::Isometry3d& b) {
  const Eigen::Isometry3d between = a.inverse() * b;
  return {between.translation().norm(), rotation_angle(between.linear())};
}

}  // namespace stillmap
