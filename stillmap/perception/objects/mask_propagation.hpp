// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/perception/objects/frame_objects.hpp"
#include "stillmap/perception/objects/object_depth.hpp"
#include "stillmap/perception/objects/object_view.hpp"

namespace stillmap {

struct PropagationRule {
  double depth_margin_m = 0.15;  ///< how far the object may have come nearer or gone since
  double min_kept_share = 0.25;  ///< of the carried pixels; else the box is all that is known
  OutlierRule outliers;
};

struct PropagatedMask {
  PixelPatch patch;
  MaskSource source = MaskSource::kBox;  ///< kCarried, or kBox when the patch is the whole box
};

/// The pixels that an object of a neighbouring frame has in this one, where its box is `box`: its
/// mask, moved and scaled as the box, less the pixels whose depth here does not fit its depth
/// there; pixels without depth stay. All of the box where too little remains or there is no mask.
/// `from_area` is the object's in its mask.
[[nodiscard]] PropagatedMask propagate_mask(const ObjectView& from,
                                            const MaskArea& from_area,
                                            const PixelBox& box,
                                            const DepthImage& depth,
                                            const PropagationRule& rule);

}  // namespace stillmap
