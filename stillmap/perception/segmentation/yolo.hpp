// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "stillmap/perception/segmentation/candidates.hpp"
#include "stillmap/perception/segmentation/export_kind.hpp"
#include "stillmap/perception/segmentation/found_object.hpp"
#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

/// The layout of a YOLO export. The attributes of a box are centre x and y, width, height (pixels
/// of the input), the objectness (kRows only), the score of each class, and a coefficient for each
/// prototype mask; those of kFinal are left, upper, right, lower edge, score, class number and the
/// coefficients.
enum class YoloLayout {
  kRows,     ///< YOLOv5: 1xNxA, one row per box, with objectness
  kColumns,  ///< YOLOv8 and 11: 1xAxN, one column per box, without objectness
  kFinal     ///< end to end: 1xNxA, one row per object, overlaps suppressed by the network
};

struct YoloOutputs {
  YoloLayout layout = YoloLayout::kColumns;
  TensorView boxes;
  TensorView prototypes;  ///< 1xPxHxW, covering the whole input; an empty shape: there are none
};

/// The outputs of a network of one of YOLO's kinds.
[[nodiscard]] YoloOutputs yolo_outputs(const NetworkExport& network,
                                       const std::vector<Tensor>& outputs);

/// A candidate for the best class of each box with a score of at least `min_score`, in pixels of
/// the input. `source` is the number of the box. Throws Error for shapes that do not fit `classes`,
/// for scores outside [0, 1], and for invalid class numbers.
[[nodiscard]] std::vector<Candidate> decode_yolo_boxes(const YoloOutputs& outputs,
                                                       std::size_t classes,
                                                       float min_score);

/// The objects of such candidates (in pixels of the input) with their masks if there are
/// prototypes. The mask has the pixels in the box at which the sum of the prototypes, weighted by
/// the coefficients of the box and interpolated at the pixels of the image, is positive (a
/// probability above 0.5). `names` are the class names.
[[nodiscard]] std::vector<FoundObject> yolo_objects(const YoloOutputs& outputs,
                                                    const std::vector<Candidate>& candidates,
                                                    const std::vector<std::string>& names,
                                                    const InputPlacement& placement,
                                                    cv::Size image);

}  // namespace stillmap
