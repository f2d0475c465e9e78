// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"

namespace stillmap {

struct VisibilityOptions {
  double point_radius_m = 0.02;  ///< each point stands for a disc of that size, facing the camera
  double margin_m = 0.2;  ///< how far behind the front-most disc a point still counts as seen
};

/// Indices, ascending, of the points that a camera sees before all others, by a z-buffer in cells
/// of 4 pixels. What is not in its ViewCone neither counts nor hides others.
[[nodiscard]] std::vector<std::uint32_t> visible_points(std::span<const Eigen::Vector3f> p_world,
                                                        const Eigen::Isometry3d& T_world_camera,
                                                        const CameraModel& camera,
                                                        const VisibilityOptions& options);

}  // namespace stillmap
