// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "stillmap/core/images.hpp"
#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/objects/object_view.hpp"

namespace stillmap {

/// The pixels of an object of which only the box is known, by depth.
///
/// The object's layer is the nearest depth that much of the middle of the box has, or the one next
/// to `expected_depth_m`, which is the object's in an earlier frame. Pixels of that layer in the
/// middle are certainly the object's; pixels around the box, and those much nearer or farther, are
/// certainly not. Every other pixel goes to the side that it is connected with by the shorter way,
/// on which a step in depth counts as a long way: so neither the floor below nor the wall behind
/// joins. Pixels of other objects in `mask` are not the object's. Returns an empty patch where the
/// box is too small or shows no layer.
[[nodiscard]] PixelPatch mask_from_depth(const DepthImage& depth,
                                         const ObjectMask& mask,
                                         const PixelBox& box,
                                         std::optional<float> expected_depth_m = std::nullopt);

/// Gives every object without pixels those of mask_from_depth(), the surest object first.
/// `expected_depths_m` has one value per object. Returns, per object, whether its pixels are such.
std::vector<bool> complete_masks(FrameDetections& detections,
                                 const DepthImage& depth,
                                 const std::vector<std::optional<float>>& expected_depths_m);

}  // namespace stillmap
