// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "stillmap/perception/segmentation/candidates.hpp"
#include "stillmap/perception/segmentation/found_object.hpp"
#include "stillmap/perception/segmentation/network_input.hpp"
#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

/// The class of every pixel of an image. Class 0 is the background.
struct ClassMap {
  cv::Mat1b labels;
  cv::Mat1f probability;  ///< of that class, in [0, 1]
};

/// The class map of a semantic network's output: CxHxW (or HxWxC), logits or probabilities, or HxW,
/// the classes themselves, each maybe with ones in front. The outlines are those of the
/// interpolated values, not of the output's coarser pixels. `placement` is of the image on the
/// network's input. Throws Error for another shape and for more than 256 classes.
[[nodiscard]] ClassMap decode_class_map(const TensorView& output,
                                        bool channels_last,
                                        const InputPlacement& placement,
                                        cv::Size image);

struct ComponentOptions {
  int min_pixels = 400;  ///< smaller ones are not taken for objects
};

/// Every connected region of a class as an object: for a class map alone. Its box is that of its
/// pixels, its score their mean probability. `names` are those of the classes, of the background
/// first.
[[nodiscard]] std::vector<FoundObject> objects_of_class_map(const ClassMap& map,
                                                            const std::vector<std::string>& names,
                                                            const ComponentOptions& options);

/// Gives every object without a mask the pixels of its class that are in its box, clipped to the
/// image; none when the map does not know its class.
[[nodiscard]] std::vector<FoundObject> with_class_pixels(std::vector<FoundObject> objects,
                                                         const ClassMap& map,
                                                         const std::vector<std::string>& names);

}  // namespace stillmap
