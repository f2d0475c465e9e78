// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// The camera that takes the depth images, where these are not registered to the color images.
struct DepthCamera {
  /// Size and lens of the depth images. Its name, depth factor and readout mean nothing: those of
  /// the color camera hold.
  CameraModel camera;
  /// From the depth camera's coordinates to the color camera's, metres.
  Eigen::Isometry3d T_color_depth = Eigen::Isometry3d::Identity();
};

}  // namespace stillmap
