// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/perception/segmentation/candidates.hpp"
#include "stillmap/perception/segmentation/export_kind.hpp"
#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

/// The outputs of RT-DETR for its Q queries.
struct DetrOutputs {
  Tensor boxes;   ///< Qx4: centre x and y, width, height, as shares of the input
  Tensor scores;  ///< QxC, probabilities or their logits
};

/// The outputs of a network of ExportKind::kDetr, with one output or two.
[[nodiscard]] DetrOutputs detr_outputs(const NetworkExport& network,
                                       const std::vector<Tensor>& outputs);

/// A candidate for the best class of each query with a score of at least `min_score`, in pixels of
/// the input. Throws Error for shapes that do not fit, and for boxes that are no shares.
[[nodiscard]] std::vector<Candidate> decode_detr(const DetrOutputs& outputs,
                                                 cv::Size input,
                                                 float min_score);

}  // namespace stillmap
