// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "stillmap/core/trajectory.hpp"
#include "tooling/eval/statistics.hpp"

namespace stillmap {

struct RpeResult {
  double delta_s = 1.0;
  std::size_t pairs = 0;
  Statistics translation_m;
  Statistics rotation_deg;
};

/// The relative pose error as the script of the TUM RGB-D benchmark computes it with a fixed delta
/// in seconds: each estimated pose is paired with the pose nearest to `delta_s` later, and compared
/// with the ground-truth poses nearest in time to both. Pairs that end at the last estimated pose
/// are left out, as are pairs whose ground truth is farther in time than twice the median interval
/// of the ground truth. All pairs count (the script draws 10000 at random from more). Nothing with
/// fewer than two pairs, or with fewer than two ground-truth poses.
///
/// The angle comes from the arc cosine of the trace, as in the script; angles below about 1e-6
/// degrees are not resolved.
[[nodiscard]] std::optional<RpeResult> relative_pose_error(const Trajectory& groundtruth,
                                                           const Trajectory& estimate,
                                                           double delta_s = 1.0);

/// The relative pose error against ground truth interpolated at the stamps of the estimate, for
/// ground truth with few poses. Estimated poses before the first and after the last true pose, and
/// those between true poses that are farther apart than twice their median interval, are left out.
[[nodiscard]] std::optional<RpeResult> interpolated_relative_pose_error(
    const Trajectory& groundtruth, const Trajectory& estimate, double delta_s = 1.0);

/// How far in time the ground truth is from the poses of the estimate that relative_pose_error()
/// compares with it: the 95 % quantile, seconds. 0 where it compares none.
[[nodiscard]] double groundtruth_distance_s(const Trajectory& groundtruth,
                                            const Trajectory& estimate);

}  // namespace stillmap
