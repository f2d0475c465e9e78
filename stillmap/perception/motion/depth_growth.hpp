// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/perception/objects/object_depth.hpp"
#include "stillmap/perception/objects/object_view.hpp"

namespace stillmap {

struct GrowthRule {
  DepthInterval seeds;    ///< mask pixels of these depths are the object's
  float margin_m = 0;     ///< pixels out of the mask join with depths this far beyond its own
  double large_part = 1;  ///< share of the mask that is the object's at any depth
  float step_m = 0;       ///< neighbours hang together when they differ less than
  float step_per_m = 0;   ///< step_m + step_per_m z^2
  int longest_way_px = 0;
  double min_mask_share = 0;
  bool drop_outliers = false;
  HalfDepth known_static;  ///< depth of the static surface, which must not join; may be empty
  float static_m = 0;      ///< how near to it: static_m + static_per_m z^2
  float static_per_m = 0;
};

/// The pixels in `area` that hang together in depth with an object's mask; see extend_mask().
[[nodiscard]] PixelPatch grow_in_depth(const ObjectView& object,
                                       const cv::Rect& area,
                                       const GrowthRule& rule);

}  // namespace stillmap
