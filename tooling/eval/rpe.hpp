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

/// Relative pose error as the TUM RGB-D benchmark's script gives it with a fixed delta in seconds:
/// each estimated pose with the one nearest to `delta_s` later, against the ground-truth poses
/// nearest in time to both. Pairs that end at the last pose of the estimate are left out, and so
/// are those whose ground truth is farther in time than twice the median interval of the ground
/// truth. All pairs count (the script draws 10000 at random from more). Nothing with fewer than two
/// pairs, or with fewer than two ground-truth poses.
///
/// The angle comes from the arc cosine of the trace, as in the script, which resolves no angle
/// below about 1e-6 degrees.
[[nodiscard]] std::optional<RpeResult> relative_pose_error(const Trajectory& groundtruth,
                                                           const Trajectory& estimate,
                                                           double delta_s = 1.0);

}  // namespace stillmap
