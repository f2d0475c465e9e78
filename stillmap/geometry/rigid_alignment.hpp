// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Geometry>

namespace stillmap {

/// The rigid transform T_target_source that minimises sum |target_i - T source_i|^2, without scale,
/// in closed form (Horn 1987; SVD as in Umeyama 1991, never a reflection). Both spans have the same
/// length of at least one. If the points do not determine the rotation (fewer than three, or on a
/// line), the result is one of the best transforms.
[[nodiscard]] Eigen::Isometry3d align_rigid(std::span<const Eigen::Vector3d> source,
                                            std::span<const Eigen::Vector3d> target);

}  // namespace stillmap
