// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "stillmap/core/ids.hpp"
#include "stillmap/slam/features/descriptor.hpp"

namespace stillmap {

struct Observation {
  KeyframeId keyframe;
  std::uint32_t feature = 0;  ///< index in the key frame's features

  [[nodiscard]] bool operator==(const Observation&) const = default;
};

/// A point of the world that key frames see.
struct Landmark {
  LandmarkId id;
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  std::vector<Observation> observations;  ///< by key frame, at most one each, never empty
  KeyframeId created_by;

  // Derived from the observations by Map::refresh().
  Descriptor descriptor{};                                      ///< nearest to all the others
  Eigen::Vector3d viewing_direction = Eigen::Vector3d::Zero();  ///< mean, from camera to point
  double min_distance_m = 0;  ///< nearer or farther its corner falls off the pyramid
  double max_distance_m = 0;

  // How often tracking expected to see it, and did.
  int times_expected = 1;
  int times_found = 1;
};

}  // namespace stillmap
