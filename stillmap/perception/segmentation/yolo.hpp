// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "stillmap/perception/segmentation/candidates.hpp"
#include "stillmap/perception/segmentation/found_object.hpp"
#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

/// A YOLO segmentation export. Its boxes have the attributes middle x, y, width, height (pixels of
/// the input), [that there is an object,] the score of each class, and a coefficient for each
/// prototype of a mask.
enum class YoloLayout {
  kRows,    ///< YOLOv5: 1xNxA, a row a box, with the score that there is an object
  kColumns  ///< YOLOv8 and 11: 1xAxN, a column a box, without
};

struct YoloOutputs {
  YoloLayout layout = YoloLayout::kColumns;
  TensorView boxes;
  TensorView prototypes;  ///< 1xPxHxW, laid over the whole input
};

/// The number of classes. Throws Error for shapes that do not fit.
[[nodiscard]] int yolo_class_count(const YoloOutputs& outputs);

/// Every box's best class that scores at least `min_score`, in pixels of the input. A candidate's
/// `source` is the number of its box. Throws Error for shapes that do not fit.
[[nodiscard]] std::vector<Candidate> decode_yolo_boxes(const YoloOutputs& outputs, float min_score);

/// The objects of such candidates (still in pixels of the input) with their masks: where the sum of
/// the prototypes, weighted by the box's coefficients and interpolated at the image's pixels, is
/// positive (a probability above 0.5) and in the box. `names` are those of the classes.
[[nodiscard]] std::vector<FoundObject> yolo_objects(const YoloOutputs& outputs,
                                                    const std::vector<Candidate>& candidates,
                                                    const std::vector<std::string>& names,
                                                    const InputPlacement& placement,
                                                    cv::Size image);

}  // namespace stillmap
