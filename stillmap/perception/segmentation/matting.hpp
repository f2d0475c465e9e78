// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/types.hpp>

#include "stillmap/perception/segmentation/found_object.hpp"
#include "stillmap/perception/segmentation/network_input.hpp"
#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

/// The square crop around a person's box: its centre is that of the box, its side `scale` times the
/// longer side of the box.
[[nodiscard]] PixelBox crop_square(const PixelBox& box, double scale);

/// Gives a person the pixels of its box at which the output of a matting network is at least
/// `threshold`. `output` is HxW, with ones before or after; `placement` is that of the image on the
/// input of the network. Throws Error for an output of another shape.
[[nodiscard]] FoundObject with_matting(FoundObject person,
                                       const TensorView& output,
                                       float threshold,
                                       const InputPlacement& placement,
                                       cv::Size image);

}  // namespace stillmap
