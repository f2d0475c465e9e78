// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/ids.hpp"

namespace stillmap {

/// An edge of the pose graph between two key frames that were found to show one place.
struct LoopEdge {
  KeyframeId a;
  KeyframeId b;
  /// Coordinates of b's camera to those of a's.
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  double sigma_m = 0.005;  ///< as its matches fix it; more is assumed, for they agree too well
  double sigma_rad = 0.002;
};

/// Two key frames that show one place, with the matches that prove it.
struct LoopMatch {
  LoopEdge edge;  ///< of two views that are no key frames, the ids are invalid
  /// (feature of a, feature of b) that see one point: their points agree with both images.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> matches;
  int expected = 0;  ///< points of b that a should see

  /// Share of the expected points that were matched.
  [[nodiscard]] double share() const {
    return expected > 0 ? static_cast<double>(matches.size()) / expected : 0.0;
  }
};

}  // namespace stillmap
