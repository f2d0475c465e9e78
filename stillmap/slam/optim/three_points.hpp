// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "stillmap/slam/optim/reprojection.hpp"

namespace stillmap {

/// Points from which a rigid motion follows, in the frame of one camera.
using PointTriple = std::array<Eigen::Vector3d, 3>;

/// Whether a rigid motion may lead from one to the other, as it keeps distances: as well as a depth
/// sensor can tell, whose errors grow with depth squared. Never for points less than 0.1 m apart,
/// which tell no rotation.
[[nodiscard]] bool same_shape(const PointTriple& a, const PointTriple& b);

/// Whether a point falls where it was measured, within twice the error that is allowed for a true
/// one: for poses of three points, which have errors of their own.
[[nodiscard]] bool near_measurement(const CameraModel& camera,
                                    const PointMeasurement& measurement,
                                    const Eigen::Vector3d& p_camera);

}  // namespace stillmap
