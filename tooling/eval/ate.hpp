// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/trajectory.hpp"
#include "tooling/eval/statistics.hpp"

namespace stillmap {

/// A pose of the estimate with the true position at its time.
struct AtePair {
  Stamp stamp;                       ///< of the estimate
  Eigen::Vector3d groundtruth;       ///< metres, in the ground truth's frame
  Eigen::Vector3d estimate_aligned;  ///< metres, in the ground truth's frame
  double error_m = 0.0;              ///< their distance
};

struct AteResult {
  Statistics translation_m;
  Eigen::Isometry3d T_groundtruth_estimate;  ///< takes the estimate's world to the ground truth's
  std::vector<AtePair> pairs;                ///< in the order of their stamps
};

/// Absolute trajectory error as the TUM RGB-D benchmark's script gives it: positions paired by
/// stamps less than 0.02 s apart (see associate()), the estimate moved by the rotation and
/// translation that fit best (no scale), statistics of the distances left. Nothing with fewer than
/// three pairs, which leave the alignment open.
[[nodiscard]] std::optional<AteResult> absolute_trajectory_error(const Trajectory& groundtruth,
                                                                 const Trajectory& estimate);

}  // namespace stillmap
