// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/features/matcher.hpp"

namespace stillmap {

/// Matches the features of a frame (queries) to those of the next by appearance, within `radius_px`
/// of where they would be if they stood still under `T_current_previous`. Without it the camera is
/// taken to stand still too. Depth is not asked to agree: what moves is wanted as well.
[[nodiscard]] std::vector<FeatureMatch> match_consecutive(
    const Features& previous,
    const Features& current,
    const CameraModel& camera,
    const std::optional<Eigen::Isometry3d>& T_current_previous,
    double radius_px,
    const MatchRules& rules);

}  // namespace stillmap
