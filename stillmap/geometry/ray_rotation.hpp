// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/geometry/point_match.hpp"

namespace stillmap {

/// The rotation that turns the rays of most matches into one another best, as if the camera had
/// only turned. At least three matches.
[[nodiscard]] Eigen::Matrix3d ray_rotation(const CameraModel& camera,
                                           std::span<const PointMatch> matches);

/// How far a match is from where it would be if the camera had turned by `R` alone, pixels;
/// infinite when turned out of view.
[[nodiscard]] double rotation_residual_px(const CameraModel& camera,
                                          const Eigen::Matrix3d& R_current_previous,
                                          const PointMatch& match);

}  // namespace stillmap
