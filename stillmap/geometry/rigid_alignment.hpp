// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Geometry>

namespace stillmap {

/// The rigid transform T_target_source that minimises sum |target_i - T source_i|^2, without scale,
/// in closed form (Horn 1987; SVD as in Umeyama 1991, never a reflection). Both spans have the same
/// length, at least one point. Where the points leave a rotation undetermined (fewer than three, or
/// on a line), one of the best transforms is returned.
[[nodiscard]] Eigen::Isometry3d align_rigid(std::span<const Eigen::Vector3d> source,
                                            std::span<const Eigen::Vector3d> target);

}  // namespace stillmap
