// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "stillmap/perception/segmentation/candidates.hpp"
#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

/// NanoDet's outputs at one resolution. Cell i, row by row, stands for the point at
/// (column + 0.5, row + 0.5) * stride of the input.
struct NanoDetLevel {
  int stride = 0;     ///< pixels of the input
  TensorView scores;  ///< NxC in [0, 1]
  /// Nx(4*B): for the distances from the point to the left, upper, right and lower edge the logits
  /// of 0, 1, ... B - 1 strides; the distance is their mean.
  TensorView boxes;
};

/// Every class of every cell that scores at least `min_score`, in pixels of the input. Throws Error
/// for shapes that do not fit each other or the input.
[[nodiscard]] std::vector<Candidate> decode_nanodet(std::span<const NanoDetLevel> levels,
                                                    cv::Size input,
                                                    float min_score);

}  // namespace stillmap
