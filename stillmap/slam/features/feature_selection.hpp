// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/features/features.hpp"

namespace stillmap {

/// The features with `keep[i]` not 0, in order. `keep` has one value per feature.
[[nodiscard]] Features select_features(const Features& features,
                                       std::span<const std::uint8_t> keep,
                                       const CameraModel& camera);

/// The features of both, those of `a` first; those without trust are trusted.
[[nodiscard]] Features joined_features(const Features& a,
                                       const Features& b,
                                       const CameraModel& camera);

}  // namespace stillmap
