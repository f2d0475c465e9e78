// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/perception/segmentation/candidates.hpp"
#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

/// Decodes the outputs of CenterNet, channels last. `heat` is HxWxC in [0, 1]; a local maximum (of
/// 3x3 cells) of at least `min_score` is an object of that class. `sizes` is HxWx4: the distances
/// from the point of the cell to the left, upper, right and lower edge, in pixels of the input.
/// Throws Error for shapes that do not fit.
[[nodiscard]] std::vector<Candidate> decode_centernet(const TensorView& heat,
                                                      const TensorView& sizes,
                                                      cv::Size input,
                                                      float min_score);

}  // namespace stillmap
