// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "stillmap/core/rgbd_frame.hpp"

namespace stillmap {

/// How much later than the colour image the depth image was taken by its stamp. 0 where it has none
/// of its own, or one more than 0.1 s off, which is of another clock.
[[nodiscard]] inline double depth_stamp_after_color_s(const RgbdFrame& frame) {
  if (frame.depth_stamp_s == 0) return 0;
  const double after_s = frame.depth_stamp_s - frame.stamp.seconds;
  return std::abs(after_s) <= 0.1 ? after_s : 0;
}

}  // namespace stillmap
