// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "stillmap/core/images.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/objects/object_view.hpp"

namespace stillmap {

/// The area that the silhouette of an object of a class (its COCO name) has at most, from any side,
/// in square metres: generous, to separate objects from furniture and walls.
[[nodiscard]] double largest_silhouette_m2(std::string_view class_name);

/// The area of the silhouette of a patch, in square metres, by the depths of every second pixel in
/// every second row; pixels without depth have the mean depth of the others. 0 without any depth.
[[nodiscard]] double silhouette_m2(const PixelPatch& patch,
                                   const DepthImage& depth,
                                   const CameraModel& camera);

}  // namespace stillmap
