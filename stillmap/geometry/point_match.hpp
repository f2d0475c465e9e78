// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace stillmap {

/// One point seen in two consecutive frames, at ideal pixels.
struct PointMatch {
  Eigen::Vector2d previous_px;
  Eigen::Vector2d current_px;
  double previous_depth_m = 0;  ///< 0 where unknown
  double current_depth_m = 0;   ///< 0 where unknown
};

}  // namespace stillmap
