// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/sensor/associate.hpp"

namespace stillmap {

/// The index pairs (ground truth, estimate) of poses less than `max_difference_s` apart. Each pose
/// is used at most once; see associate().
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> pair_poses(
    const Trajectory& groundtruth,
    const Trajectory& estimate,
    double max_difference_s = kMaxStampDifferenceS);

}  // namespace stillmap
