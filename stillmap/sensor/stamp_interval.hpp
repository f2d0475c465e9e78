// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace stillmap {

/// Frames farther apart on average than this, in seconds, are not those of a camera: their stamps
/// are in another unit.
inline constexpr double kMaxFrameInterval_s = 1000;

[[nodiscard]] inline bool is_absurd_interval(double interval_s) {
  return interval_s > kMaxFrameInterval_s;
}

}  // namespace stillmap
