// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/types.hpp>

#include "stillmap/perception/segmentation/found_object.hpp"
#include "stillmap/perception/segmentation/network_input.hpp"
#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

/// The square that a person's box is cut out with: its middle is the box's, its side `scale` times
/// the box's longer one.
[[nodiscard]] PixelBox crop_square(const PixelBox& box, double scale);

/// Gives a person the pixels of its box where a matting network sees one in the crop: `output`, HxW
/// with ones before or after, at least `threshold`; `placement` is of the image on the network's
/// input. Throws Error for an output of another shape.
[[nodiscard]] FoundObject with_matting(FoundObject person,
                                       const TensorView& output,
                                       float threshold,
                                       const InputPlacement& placement,
                                       cv::Size image);

}  // namespace stillmap
