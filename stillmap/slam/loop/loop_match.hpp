// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/ids.hpp"

namespace stillmap {

/// The measured relative pose of two key frames that show one place: an edge of the pose graph.
struct LoopEdge {
  KeyframeId a;
  KeyframeId b;
  /// From the camera frame of b to that of a.
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  /// by the matches alone; closing assumes more, as their errors correlate
  double sigma_m = 0.005;
  double sigma_rad = 0.002;
};

/// Two key frames that show one place, with the matches that prove it.
struct LoopMatch {
  LoopEdge edge;  ///< ids are invalid for views of no key frame
  /// Pairs (feature of a, feature of b) that show one point, consistent with both images.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> matches;
  int expected = 0;  ///< number of points of b that should be visible in a

  /// The share of the expected points that were matched.
  [[nodiscard]] double share() const {
    return expected > 0 ? static_cast<double>(matches.size()) / expected : 0.0;
  }
};

}  // namespace stillmap
