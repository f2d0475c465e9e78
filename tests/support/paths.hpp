// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "stillmap/geometry/se3.hpp"

namespace stillmap {

inline constexpr double kFrameInterval_s = 1.0 / 30.0;

/// The path of a swinging hand-held camera: begins at the origin, stays within 0.5 m of it, moves
/// at up to `speed` times 0.6 m/s and 0.6 rad/s.
[[nodiscard]] inline Eigen::Isometry3d swinging(double time_s, double speed = 1.0) {
  const double t = speed * time_s;
  const Eigen::Vector3d turn(
      0.15 * std::sin(1.3 * t), 0.35 * std::sin(0.9 * t), 0.1 * std::sin(1.7 * t));
  const Eigen::Vector3d place(
      0.4 * std::sin(1.1 * t), 0.2 * std::sin(1.5 * t), 0.25 * (1.0 - std::cos(0.8 * t)));
  return make_pose(so3_exp(turn), place);
}

}  // namespace stillmap
