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

/// The supported kinds of networks. The shapes of the outputs distinguish them.
enum class ExportKind {
  kClassMap,     ///< one output: 1xCxHxW, or 1xHxW with class numbers
  kYoloRows,     ///< YOLOv5 segmentation: 1xNxA and 1xPxHxW, N > A
  kYoloColumns,  ///< YOLOv8 or 11 segmentation: 1xAxN and 1xPxHxW, N > A
  kSsd,          ///< BlitzNet: anchors Nx4, offsets 1xNx4, classes 1xNxC, class map 1xCxHxW
  kNanoDet,      ///< for each resolution 1xNxC and 1xNx4B; boxes only
  kCenterNet     ///< 1xHxWxC and 1xHxWx4; boxes only
};

struct NetworkExport {
  ExportKind kind = ExportKind::kClassMap;
  /// The numbers of the outputs, in this order. Class map: the map. YOLO: boxes, prototypes. SSD:
  /// anchors, offsets, classes, class map. NanoDet: classes and boxes for each resolution.
  /// CenterNet: classes, sizes.
  std::vector<std::size_t> outputs;
  std::vector<std::string> names;  ///< class names; for class map and SSD the background's first
};

/// The shape of the image input: 1x3xHxW or 1xHxWx3. Sizes that the network leaves open become
/// those of the image, rounded up to a multiple of 32. Throws Error for a network with another
/// input.
[[nodiscard]] TensorShape image_input_shape(const NetworkSignature& signature, cv::Size image);

/// Identifies a network by the shapes of its outputs in a run. Throws Error for an unknown kind,
/// and for classes without names.
[[nodiscard]] NetworkExport identify_export(const NetworkSignature& signature,
                                            const std::vector<TensorShape>& outputs);

/// The quoted words of a list or dictionary, in their order: {0: 'person', 1: "driver's seat"}.
[[nodiscard]] std::vector<std::string> quoted_words(std::string_view text);

}  // namespace stillmap
