// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"

namespace stillmap {

struct VisibilityOptions {
  double point_radius_m = 0.02;  ///< a point counts as a disc of this radius, facing the camera
  double margin_m = 0.2;  ///< distance behind the front-most disc within which a point is visible
};

/// The indices, ascending, of the points that a camera sees in front of all others, by a z-buffer
/// with cells of 4 pixels. Points outside its ViewCone are invisible and hide nothing.
[[nodiscard]] std::vector<std::uint32_t> visible_points(std::span<const Eigen::Vector3f> p_world,
                                                        const Eigen::Isometry3d& T_world_camera,
                                                        const CameraModel& camera,
                                                        const VisibilityOptions& options);

}  // namespace stillmap
