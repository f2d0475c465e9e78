// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// A camera without distortion that looks through the middle of its image. For tests.
inline CameraModel centered_camera(int width_px, int height_px, double focal_px) {
  CameraModel camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.fx = camera.fy = focal_px;
  camera.cx = 0.5 * (width_px - 1);
  camera.cy = 0.5 * (height_px - 1);
  return camera;
}

}  // namespace stillmap
