// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "stillmap/perception/detections/detections.hpp"

namespace stillmap {

/// The area of the intersection of two boxes; 0 when they only touch.
[[nodiscard]] inline double shared_area(const PixelBox& a, const PixelBox& b) {
  const double width = std::min(a.x1, b.x1) - std::max(a.x0, b.x0);
  const double height = std::min(a.y1, b.y1) - std::max(a.y0, b.y0);
  return width > 0 && height > 0 ? width * height : 0.0;
}

/// Intersection over union of two boxes, in [0, 1].
[[nodiscard]] inline double box_iou(const PixelBox& a, const PixelBox& b) {
  const double shared = shared_area(a, b);
  return shared > 0 ? shared / (a.area() + b.area() - shared) : 0.0;
}

}  // namespace stillmap
