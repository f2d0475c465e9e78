// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace stillmap {

/// A time as a file gave it. The text is kept because outputs repeat stamps exactly as they were
/// read; a double holds them only to about 0.2 microseconds.
struct Stamp {
  double seconds = 0.0;
  std::string text;
};

struct StampedPose {
  Stamp stamp;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// Poses in the order of their stamps, strictly increasing.
using Trajectory = std::vector<StampedPose>;

}  // namespace stillmap
