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

/// A 3-D point that key frames observe.
struct Landmark {
  LandmarkId id;
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  std::vector<Observation> observations;  ///< by key frame, at most one each; never empty
  KeyframeId created_by;

  // Derived from the observations by Map::refresh().
  Descriptor descriptor{};  ///< the one with the least median distance to the others
  /// mean direction from camera to point
  Eigen::Vector3d viewing_direction = Eigen::Vector3d::Zero();
  double min_distance_m = 0;  ///< at other distances its corner is on no pyramid level
  double max_distance_m = 0;

  // The numbers of frames in which tracking expected it, and found it.
  int times_expected = 1;
  int times_found = 1;
};

}  // namespace stillmap
