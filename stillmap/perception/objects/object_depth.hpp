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

/// The area of an id in the image.
struct MaskArea {
  cv::Rect bounds;  ///< the smallest rectangle with all its pixels
  std::size_t pixels = 0;
};

/// The area of each id; that of 0 is left empty. Takes one pass over the mask.
using MaskAreas = std::array<MaskArea, 256>;
[[nodiscard]] MaskAreas mask_areas(const ObjectMask& mask);

/// Statistics of the depths under the mask of an object.
struct ObjectDepths {
  std::size_t measured = 0;               ///< pixels of the mask with depth
  float median_m = 0;                     ///< 0 without depth
  float mad_m = 0;                        ///< median absolute deviation
  std::optional<DepthInterval> interval;  ///< without the outliers; none without depth
};

/// The rule for outliers among the depths of an object: depths farther from the median than
/// `mad_factor` times 1.4826 MAD, and farther than `min_reach_m`.
struct OutlierRule {
  double mad_factor = 3.0;
  double min_reach_m = 0.0;
};

/// The depths of the pixels of an id (D_i, L and U of Fan 2020, section III-A, Eqs. (2)-(3)). The
/// median is accurate to a millimetre; depth beyond 16 m counts as missing. `area` is the area of
/// the id; `mask` may be empty.
[[nodiscard]] ObjectDepths object_depths(const DepthImage& depth,
                                         const ObjectMask& mask,
                                         int id,
                                         const MaskArea& area,
                                         const OutlierRule& rule);

}  // namespace stillmap
