// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/perception/objects/object_depth.hpp"
#include "stillmap/perception/objects/object_view.hpp"

namespace stillmap {

struct GrowthRule {
  DepthInterval seeds;  ///< depths of mask pixels that belong to the object
  float margin_m = 0;   ///< widening of that interval for pixels outside the mask
  /// share of the mask above which a part belongs to the object at any depth
  double large_part = 1;
  float step_m = 0;      ///< neighbours are connected when they differ by less than
  float step_per_m = 0;  ///< step_m + step_per_m z^2
  int longest_way_px = 0;
  double min_mask_share = 0;
  bool drop_outliers = false;
  HalfDepth known_static;  ///< depth of static surface, which must not join; may be empty
  float static_m = 0;      ///< pixels within static_m + static_per_m z^2 of it do not join
  float static_per_m = 0;
};

/// The pixels in `area` that are connected in depth to the mask of an object; see extend_mask().
[[nodiscard]] PixelPatch grow_in_depth(const ObjectView& object,
                                       const cv::Rect& area,
                                       const GrowthRule& rule);

}  // namespace stillmap
