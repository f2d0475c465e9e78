// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/perception/segmentation/candidates.hpp"
#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

/// The outputs of a single-shot detector such as BlitzNet for its N anchors.
struct SsdOutputs {
  TensorView anchors;  ///< Nx4: left edge, upper edge, width, height, as shares of the input
  /// Nx4: shift of the centre in tenths of the anchor's width and height, then five times the
  /// logarithms of the ratios of width and height.
  TensorView offsets;
  TensorView classes;  ///< NxC, logits or probabilities; class 0 is the background
};

/// A candidate for each class of each anchor with a score of at least `min_score`, without the
/// background, in pixels of the input. Label 0 is the first class after the background. Throws
/// Error for shapes that do not fit.
[[nodiscard]] std::vector<Candidate> decode_ssd(const SsdOutputs& outputs,
                                                cv::Size input,
                                                float min_score);

}  // namespace stillmap
