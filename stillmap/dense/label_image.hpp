// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <opencv2/core/mat.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/dense/local_cloud.hpp"
#include "stillmap/perception/motion/dynamics_stage.hpp"

namespace stillmap {

/// The number that stands for a class in the map: its place in coco_class_names() counted from 1;
/// 0 for a class that COCO does not have.
[[nodiscard]] std::uint8_t class_label(std::string_view class_name);

/// The labels of a frame: class_label() of the object that has the pixel and is static in this
/// frame, 0 elsewhere. A pixel counts when the network, in this frame or in one near to it, has
/// given it to the object, and its depth is the object's. Empty where no object has pixels; else as
/// large as `depth`.
[[nodiscard]] LabelImage label_image(const DepthImage& depth, const FrameDynamics& dynamics);

}  // namespace stillmap
