// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/types.hpp>

#include "stillmap/perception/segmentation/network.hpp"
#include "stillmap/perception/segmentation/network_input.hpp"

namespace stillmap {

/// The kinds of networks that are understood, told apart by the shapes of their outputs.
enum class ExportKind {
  kClassMap,     ///< one output: 1xCxHxW, or 1xHxW with the classes themselves
  kYoloRows,     ///< YOLOv5 segmentation: 1xNxA and 1xPxHxW, N > A
  kYoloColumns,  ///< YOLOv8 or 11 segmentation: 1xAxN and 1xPxHxW, N > A
  kSsd,          ///< BlitzNet: anchors Nx4, offsets 1xNx4, classes 1xNxC, class map 1xCxHxW
  kNanoDet,      ///< for each resolution 1xNxC and 1xNx4B; boxes only
  kCenterNet     ///< 1xHxWxC and 1xHxWx4; boxes only
};

struct NetworkExport {
  ExportKind kind = ExportKind::kClassMap;
  /// Which output is which. Class map: itself. YOLO: boxes, prototypes. SSD: anchors, offsets,
  /// classes, class map. NanoDet: classes, boxes for each resolution. CenterNet: classes, sizes.
  std::vector<std::size_t> outputs;
  std::vector<std::string> names;  ///< of the classes; of the background first in class map and SSD
};

/// The shape of an input for images: 1x3xHxW or 1xHxWx3. What the network leaves open becomes the
/// image's size, rounded up to a multiple of 32. Throws Error for a network with another input.
[[nodiscard]] TensorShape image_input_shape(const NetworkSignature& signature, cv::Size image);

/// What a network is, by the shapes that its outputs had in a run. Throws Error when that is
/// nothing known, or when its classes have no names.
[[nodiscard]] NetworkExport identify_export(const NetworkSignature& signature,
                                            const std::vector<TensorShape>& outputs);

/// The quoted words of a list or dictionary, in their order: {0: 'person', 1: "driver's seat"}.
[[nodiscard]] std::vector<std::string> quoted_words(std::string_view text);

}  // namespace stillmap
