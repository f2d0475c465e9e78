// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/sensor/associate.hpp"
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
  Eigen::Isometry3d
      T_groundtruth_estimate;  ///< from the world frame of the estimate to that of the ground truth
  std::vector<AtePair> pairs;  ///< in the order of their stamps
};

/// The absolute trajectory error as the script of the TUM RGB-D benchmark computes it: positions
/// are paired by stamps less than `max_difference_s` apart (see associate()), the estimate is
/// aligned by the best rotation and translation (no scale), and the remaining distances are
/// summarised. Nothing with fewer than three pairs, which do not determine the alignment.
[[nodiscard]] std::optional<AteResult> absolute_trajectory_error(
    const Trajectory& groundtruth,
    const Trajectory& estimate,
    double max_difference_s = kMaxStampDifferenceS);

/// The scale of the estimate's positions with which the best rotation and translation leave the
/// least squares of the absolute trajectory error (Umeyama 1991, Eq. 42). Nothing with fewer than
/// three pairs, and for an estimate that does not move or moves the other way.
[[nodiscard]] std::optional<double> fitted_scale(const Trajectory& groundtruth,
                                                 const Trajectory& estimate,
                                                 double max_difference_s = kMaxStampDifferenceS);

}  // namespace stillmap
