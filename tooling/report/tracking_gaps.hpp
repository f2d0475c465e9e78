// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// Frames in a row without a pose: tracking was lost, or had not begun.
struct TrackingGap {
  Stamp first_lost;
  std::size_t frames = 0;  ///< without a pose
  /// From the first of them to the frame that was found again, else to the last of them.
  double seconds = 0;
  std::optional<Stamp> found;     ///< the first frame with a pose after it; nothing: none came
  std::optional<double> moved_m;  ///< from the last pose before it to the first after it
};

/// `lost`: the frames without a pose, in order; `estimate`: those with one. Frames in neither (they
/// could not be read) belong to no gap and end none.
[[nodiscard]] std::vector<TrackingGap> tracking_gaps(std::span<const Stamp> lost,
                                                     const Trajectory& estimate);

/// "30 frames from 103.066667, 1.03 s; found again at 104.100000, 24.1 cm from where it was lost".
[[nodiscard]] std::string gap_text(const TrackingGap& gap);

}  // namespace stillmap
