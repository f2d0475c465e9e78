// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace stillmap {

/// A time as a file gave it. The text is kept because outputs repeat stamps exactly as they were
/// read: a double resolves today's stamps to about 0.2 microseconds only.
struct Stamp {
  double seconds = 0.0;  ///< as a number, for arithmetic
  std::string text;      ///< as the file has it
};

/// The pose of a camera at one time.
struct StampedPose {
  Stamp stamp;  ///< of the colour image
  /// From camera to world coordinates, metres.
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// Poses by stamp, strictly increasing.
using Trajectory = std::vector<StampedPose>;

}  // namespace stillmap
