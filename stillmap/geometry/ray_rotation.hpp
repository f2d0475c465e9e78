// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/geometry/point_match.hpp"

namespace stillmap {

/// The rotation that best aligns the rays of most matches, as if the camera had only rotated. Needs
/// at least three matches.
[[nodiscard]] Eigen::Matrix3d ray_rotation(const CameraModel& camera,
                                           std::span<const PointMatch> matches);

/// The distance, pixels, of a match from its position under the rotation `R` alone; infinite if
/// that is out of view.
[[nodiscard]] double rotation_residual_px(const CameraModel& camera,
                                          const Eigen::Matrix3d& R_current_previous,
                                          const PointMatch& match);

}  // namespace stillmap
