// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <opencv2/core/types.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/objects/object_state.hpp"

namespace stillmap {

/// Where in the image the pixels of an id are.
struct MaskArea {
  cv::Rect bounds;  ///< the smallest that holds them all
  std::size_t pixels = 0;
};

/// By id, 0 included but left empty. One pass over the mask.
using MaskAreas = std::array<MaskArea, 256>;
[[nodiscard]] MaskAreas mask_areas(const ObjectMask& mask);

/// What is known of the depths under the mask of an object.
struct ObjectDepths {
  std::size_t measured = 0;               ///< pixels of the mask that have depth
  float median_m = 0;                     ///< 0 when nothing is measured
  float mad_m = 0;                        ///< the median distance from it
  std::optional<DepthInterval> interval;  ///< without the outliers; none when nothing is measured
};

/// Which depths of an object are outliers: those farther from the median than `mad_factor` times
/// 1.4826 times the median distance from it, and farther than `min_reach_m`.
struct OutlierRule {
  double mad_factor = 3.0;
  double min_reach_m = 0.0;
};

/// The depths of an id's pixels (D_i, L and U of Fan 2020, Eqs. (2)-(3)). The median is known to a
/// millimetre; depth beyond 16 m counts as missing. `area` is the id's; `mask` may be empty.
[[nodiscard]] ObjectDepths object_depths(const DepthImage& depth,
                                         const ObjectMask& mask,
                                         int id,
                                         const MaskArea& area,
                                         const OutlierRule& rule);

}  // namespace stillmap
