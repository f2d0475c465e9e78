// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/perception/segmentation/candidates.hpp"
#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

/// What a single-shot detector such as BlitzNet gives for each of its N anchors.
struct SsdOutputs {
  TensorView anchors;  ///< Nx4: left, upper edge, width, height as shares of the input
  /// Nx4: shift of the middle in tenths of the anchor's width and height, then five times the
  /// logarithms of the ratios of width and height.
  TensorView offsets;
  TensorView classes;  ///< NxC, logits or probabilities; class 0 is the background
};

/// Every class but the background of every anchor that scores at least `min_score`, in pixels of
/// the input; label 0 is the first class after the background. Throws Error for shapes that do not
/// fit.
[[nodiscard]] std::vector<Candidate> decode_ssd(const SsdOutputs& outputs,
                                                cv::Size input,
                                                float min_score);

}  // namespace stillmap
