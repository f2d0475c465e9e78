// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <opencv2/core/types.hpp>

#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// A pinhole with a field of view of `across` and `down` radians, whose axis meets the middle of
/// the image. Both are above 0 and below pi.
[[nodiscard]] inline CameraModel pinhole_of_view(cv::Size size, double across, double down) {
  CameraModel camera;
  camera.width_px = size.width;
  camera.height_px = size.height;
  camera.fx = 0.5 * size.width / std::tan(0.5 * across);
  camera.fy = 0.5 * size.height / std::tan(0.5 * down);
  camera.cx = 0.5 * (size.width - 1);
  camera.cy = 0.5 * (size.height - 1);
  return camera;
}

}  // namespace stillmap
