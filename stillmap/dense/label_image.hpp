// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <opencv2/core/mat.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/dense/local_cloud.hpp"
#include "stillmap/perception/motion/dynamics_stage.hpp"

namespace stillmap {

/// The label of a class in the map: its position in coco_class_names(), counted from 1; 0 for a
/// class that COCO does not have.
[[nodiscard]] std::uint8_t class_label(std::string_view class_name);

/// The labels of a frame: class_label() of the static object of each pixel, 0 elsewhere. A pixel
/// belongs to an object when the object's mask, detected or propagated, has it and its depth is
/// within those of the object. Empty if no object has a mask; else of the size of `depth`.
[[nodiscard]] LabelImage label_image(const DepthImage& depth, const FrameDynamics& dynamics);

}  // namespace stillmap
