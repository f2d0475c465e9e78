// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <opencv2/core/mat.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/perception/motion/dynamics_stage.hpp"

namespace stillmap {

/// The number that stands for a class in the map: its place in coco_class_names() counted from 1;
/// 0 for a class that COCO does not have.
[[nodiscard]] std::uint8_t class_label(std::string_view class_name);

/// What the map is to say of each pixel of a frame: the class_label() of the object that has it and
/// is static in this frame, 0 elsewhere. Only pixels count that the network, in this frame or in
/// one near to it, has given to the object, and that are as far away as the object is. Empty where
/// no object has pixels; else as large as `depth`.
[[nodiscard]] cv::Mat1b label_image(const DepthImage& depth, const FrameDynamics& dynamics);

}  // namespace stillmap
