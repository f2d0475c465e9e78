// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// Consecutive frames without a pose: tracking was lost, or had not begun.
struct TrackingGap {
  Stamp first_lost;
  std::size_t frames = 0;  ///< without a pose
  /// From the first of these frames to the first with a pose after it, else to the last of these.
  double seconds = 0;
  std::optional<Stamp> found;     ///< the first frame with a pose after the gap; nullopt: none
  std::optional<double> moved_m;  ///< from the last pose before the gap to the first after it
};

/// `lost`: the frames without a pose, in order; `estimate`: those with one. Frames in neither,
/// which could not be read, belong to no gap and end none.
[[nodiscard]] std::vector<TrackingGap> tracking_gaps(std::span<const Stamp> lost,
                                                     const Trajectory& estimate);

/// "30 frames from 103.066667, 1.03 s; found again at 104.100000, 24.1 cm from where it was lost".
[[nodiscard]] std::string gap_text(const TrackingGap& gap);

}  // namespace stillmap
