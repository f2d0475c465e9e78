// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/geometry/point_match.hpp"

namespace stillmap {

/// The camera's motion between two frames, from matches whose earlier depth is known: minimises
/// robust reprojection errors, starting from `initial`. Nothing for fewer than `min_matches`.
[[nodiscard]] std::optional<Eigen::Isometry3d> relative_motion(
    const CameraModel& camera,
    std::span<const PointMatch> matches,
    const Eigen::Isometry3d& initial_T_current_previous,
    int min_matches);

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
