// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// The pose at a time, interpolated between the poses before and after it. Before the first and
/// after the last pose it is that pose. Nothing when no pose is less than kMaxStampDifferenceS away
/// in time.
[[nodiscard]] std::optional<Eigen::Isometry3d> pose_at(const Trajectory& trajectory,
                                                       double stamp_s);

}  // namespace stillmap
