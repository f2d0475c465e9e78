// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "stillmap/perception/segmentation/candidates.hpp"
#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

/// The outputs of NanoDet at one resolution. Cell i, row by row, belongs to the point (column +
/// 0.5, row + 0.5) * stride of the input.
struct NanoDetLevel {
  int stride = 0;     ///< pixels of the input
  TensorView scores;  ///< NxC in [0, 1]
  /// Nx(4*B): for each of the distances from the point to the left, upper, right and lower edge,
  /// the logits of 0, 1, ... B - 1 strides. The distance is the mean of that distribution.
  TensorView boxes;
};

/// A candidate for each class of each cell with a score of at least `min_score`, in pixels of the
/// input. Throws Error for shapes that do not fit each other or the input.
[[nodiscard]] std::vector<Candidate> decode_nanodet(std::span<const NanoDetLevel> levels,
                                                    cv::Size input,
                                                    float min_score);

}  // namespace stillmap
