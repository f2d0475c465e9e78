// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <opencv2/core/types.hpp>

#include "stillmap/perception/detections/detections.hpp"

namespace stillmap {

/// The interpolated box of a frame (Fan 2020, section III-C, Eq. (10)) that is `since_before`
/// frames after the frame of `before` and `until_after` frames before the frame of `after`. Both
/// are at least 1.
[[nodiscard]] inline PixelBox box_between(const PixelBox& before,
                                          int since_before,
                                          const PixelBox& after,
                                          int until_after) {
  const double share = static_cast<double>(since_before) / (since_before + until_after);
  const auto mix = [share](double a, double b) { return a + (b - a) * share; };
  return {mix(before.x0, after.x0),
          mix(before.y0, after.y0),
          mix(before.x1, after.x1),
          mix(before.y1, after.y1)};
}

/// The pixels of the image that a box touches; possibly none.
[[nodiscard]] inline cv::Rect pixels_of(const PixelBox& box, cv::Size image) {
  const auto clip = [](double value, int limit) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(limit)));
  };
  const int x0 = clip(std::floor(box.x0), image.width);
  const int y0 = clip(std::floor(box.y0), image.height);
  const int x1 = clip(std::ceil(box.x1), image.width);
  const int y1 = clip(std::ceil(box.y1), image.height);
  return {x0, y0, std::max(0, x1 - x0), std::max(0, y1 - y0)};
}

}  // namespace stillmap
