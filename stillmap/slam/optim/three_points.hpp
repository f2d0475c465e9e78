// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "stillmap/slam/optim/reprojection.hpp"

namespace stillmap {

/// Three points that determine a rigid motion, in the coordinates of one camera.
using PointTriple = std::array<Eigen::Vector3d, 3>;

/// Whether a rigid motion may take one triple to the other: whether distances are equal within the
/// errors of a depth sensor, which grow with depth squared. False for points less than 0.1 m apart,
/// which do not determine a rotation.
[[nodiscard]] bool same_shape(const PointTriple& a, const PointTriple& b);

/// Whether a point agrees with its measurement, within twice the error bound of an inlier. The pose
/// of three points has an error of its own.
[[nodiscard]] bool near_measurement(const CameraModel& camera,
                                    const PointMeasurement& measurement,
                                    const Eigen::Vector3d& p_camera);

}  // namespace stillmap
