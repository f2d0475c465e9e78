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

/// The class map from the output of a semantic network: CxHxW (or HxWxC), logits or probabilities,
/// or HxW, class numbers; ones before these dimensions are ignored. The outlines are those of the
/// interpolated values, not of the coarser pixels of the output. `placement` is that of the image
/// on the input of the network. Throws Error for another shape and for more than 256 classes.
[[nodiscard]] ClassMap decode_class_map(const TensorView& output,
                                        bool channels_last,
                                        const InputPlacement& placement,
                                        cv::Size image);

struct ComponentOptions {
  int min_pixels = 400;  ///< smaller regions are no objects
};

/// The connected regions of each class as objects, for networks with a class map alone. The box of
/// an object is that of its pixels, its score their mean probability. `names` are the class names,
/// the background's first.
[[nodiscard]] std::vector<FoundObject> objects_of_class_map(const ClassMap& map,
                                                            const std::vector<std::string>& names,
                                                            const ComponentOptions& options);

/// Gives each object without a mask the pixels of its class in its box, clipped to the image; none
/// if the map does not have its class.
[[nodiscard]] std::vector<FoundObject> with_class_pixels(std::vector<FoundObject> objects,
                                                         const ClassMap& map,
                                                         const std::vector<std::string>& names);

}  // namespace stillmap
