// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>

#include <fmt/core.h>

#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// The output of the TUM benchmark's scripts for published trajectories.
struct PublishedFigures {
  const char* name;  ///< in the shared test data
  std::size_t ate_pairs;
  double ate_rmse, ate_mean, ate_median, ate_std;  ///< metres
  std::size_t rpe_pairs;
  double rpe_translation_rmse, rpe_rotation_rmse_deg;
};

inline constexpr std::array<PublishedFigures, 3> kPublished = {{
    {"fr3_walking_xyz", 828, 0.015399, 0.013156, 0.011774, 0.008003, 798, 0.019283, 0.607929},
    {"fr3_walking_static", 714, 0.006532, 0.005918, 0.005452, 0.002765, 683, 0.007779, 0.235584},
    {"fr3_sitting_static", 677, 0.005799, 0.004875, 0.004215, 0.003140, 649, 0.006830, 0.265777},
}};

/// A trajectory of `count` poses from `start_s` on, `step_s` apart; `pose` gives each by its stamp.
[[nodiscard]] inline Trajectory make_trajectory(
    std::size_t count,
    double start_s,
    double step_s,
    const std::function<Eigen::Isometry3d(double)>& pose) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < count; ++i) {
    const double seconds = start_s + static_cast<double>(i) * step_s;
    trajectory.push_back({{seconds, fmt::format("{:.6f}", seconds)}, pose(seconds)});
  }
  return trajectory;
}

}  // namespace stillmap
