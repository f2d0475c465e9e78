// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/slam/features/feature_timing.hpp"
#include "stillmap/slam/optim/bundle_adjuster.hpp"

namespace stillmap {

/// What observations tell of the camera's times, (readout_s, depth_delay_s), with all poses and
/// points free: the normal equations `information` * times = `vector`.
struct TimeEvidence {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  ///< 1/s^2
  Eigen::Vector2d vector = Eigen::Vector2d::Zero();       ///< 1/s
};

/// A solved bundle and the timing of each of its cameras.
struct TimedBundle {
  BundleProblem problem;              ///< its observations of free cameras are inliers
  std::vector<FeatureTiming> timing;  ///< per camera
  std::vector<double> row;            ///< per observation: row_position() of its feature
};

/// The evidence of the free cameras' observations: held cameras and their observations take no
/// part.
///
/// Points are free, since a point made while the camera moved steadily carries the error of a wrong
/// time: seen from there it agrees with it. Only changes of the velocity tell the times; steady
/// motion gives no information.
[[nodiscard]] TimeEvidence time_evidence(const TimedBundle& bundle);

}  // namespace stillmap
