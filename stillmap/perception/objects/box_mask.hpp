// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "stillmap/core/images.hpp"
#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/objects/object_view.hpp"

namespace stillmap {

/// The pixels, by depth, of an object of which only the box is known.
///
/// The object's layer is the nearest depth that much of the middle of the box has, or the one
/// closest to `expected_depth_m`, its depth in an earlier frame. Pixels of that layer in the middle
/// certainly belong to the object; pixels around the box, and those much nearer or farther,
/// certainly do not. Every other pixel joins the side to which its path is shorter, where a depth
/// step counts as a long path: so neither the floor below nor the wall behind joins. Pixels of
/// other objects in `mask` stay theirs. Returns an empty patch where the box is too small or shows
/// no layer.
[[nodiscard]] PixelPatch mask_from_depth(const DepthImage& depth,
                                         const ObjectMask& mask,
                                         const PixelBox& box,
                                         std::optional<float> expected_depth_m = std::nullopt);

/// The pixels, by depth, of an object whose mask is rough (PixelSource::kRoughNetwork).
///
/// As mask_from_depth(), but the object's layer is the strongest in its mask, the mask's pixels
/// near that layer belong to the object, and paths are longer where they contradict the mask. So
/// the distant background leaves the mask, and what it lacks of the object joins. Pixels without
/// depth stay as they are. Returns an empty patch where little of the mask has depth.
[[nodiscard]] PixelPatch mask_refined_by_depth(const DepthImage& depth,
                                               const ObjectMask& mask,
                                               const DetectedObject& object);

/// Gives every object without pixels those of mask_from_depth(), and every rough mask those of
/// mask_refined_by_depth() before, both by descending score. `expected_depths_m` has one value per
/// object. Sets the origins of the masks. Returns, per object, whether it had none and has one by
/// depth now.
std::vector<bool> complete_masks(FrameDetections& detections,
                                 const DepthImage& depth,
                                 const std::vector<std::optional<float>>& expected_depths_m);

}  // namespace stillmap
