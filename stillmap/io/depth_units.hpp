// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "stillmap/core/images.hpp"

namespace stillmap {

/// What some cameras write where nothing was measured.
inline constexpr std::uint16_t kSaturatedDepth = 65535;

/// Depth in metres of depth in units: the stored value / depth_factor, 0 for 0 and
/// `kSaturatedDepth`. `depth_factor`: units in a metre, above 0.
[[nodiscard]] DepthImage depth_of_units(const cv::Mat1w& units, double depth_factor);

}  // namespace stillmap
