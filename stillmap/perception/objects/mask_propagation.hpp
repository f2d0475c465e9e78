// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/perception/objects/frame_objects.hpp"
#include "stillmap/perception/objects/object_depth.hpp"
#include "stillmap/perception/objects/object_view.hpp"

namespace stillmap {

struct PropagationRule {
  double depth_margin_m = 0.15;  ///< change of depth that the object may have made since
  /// share of the propagated pixels that must remain; else the whole box is used
  double min_kept_share = 0.25;
  OutlierRule outliers;
};

struct PropagatedMask {
  PixelPatch patch;
  MaskSource source = MaskSource::kBox;  ///< kCarried, or kBox if the patch is the whole box
};

/// The pixels in this frame of an object of a neighbouring frame: its mask, moved and scaled from
/// its box there to `box` here, without the pixels whose depth here does not fit its depth there.
/// Pixels without depth remain. The whole box if too few pixels remain or there is no mask.
/// `from_area` is the area of the object in its mask.
[[nodiscard]] PropagatedMask propagate_mask(const ObjectView& from,
                                            const MaskArea& from_area,
                                            const PixelBox& box,
                                            const DepthImage& depth,
                                            const PropagationRule& rule);

}  // namespace stillmap
