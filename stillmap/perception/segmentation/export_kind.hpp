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

/// The supported kinds of networks. The outputs' shapes, the number of classes and, where these
/// allow several, the values of the outputs distinguish them.
enum class ExportKind {
  kClassMap,     ///< one output: 1xCxHxW or 1xHxWxC, or 1xHxW with class numbers
  kYoloRows,     ///< YOLOv5: 1xNxA, N > A, and 1xPxHxW if it segments
  kYoloColumns,  ///< YOLOv8 or 11: 1xAxN, N >= A, and 1xPxHxW if it segments
  kYoloFinal,    ///< YOLO end to end: 1xNx6, or 1xNx(6+P) and 1xPxHxW
  kDetr,         ///< RT-DETR: 1xQx4 and 1xQxC, or 1xQx(4+C); boxes only
  kSsd,          ///< BlitzNet: anchors Nx4, offsets 1xNx4, classes 1xNxC, class map 1xCxHxW
  kNanoDet,      ///< for each resolution 1xNxC and 1xNx4B; boxes only
  kCenterNet     ///< 1xHxWxC and 1xHxWx4; boxes only
};

struct NetworkExport {
  ExportKind kind = ExportKind::kClassMap;
  /// The numbers of the outputs, in this order. Class map: the map. YOLO: boxes, prototypes if
  /// there are any. RT-DETR: boxes, scores, or both in one. SSD: anchors, offsets, classes, class
  /// map. NanoDet: classes and boxes for each resolution. CenterNet: classes, sizes.
  std::vector<std::size_t> outputs;
  std::vector<std::string> names;  ///< class names; for class map and SSD the background's first
  bool channels_last = false;      ///< the class map's
};

/// The shape of the image input: Bx3xHxW or BxHxWx3. Sizes that the network leaves open become
/// those of the image, rounded up to a multiple of 32; an open batch becomes 1. Throws Error for a
/// network with another input.
[[nodiscard]] TensorShape image_input_shape(const NetworkSignature& signature, cv::Size image);

/// Identifies a network by its outputs in a run. `input` is the size of the image that it takes.
/// Throws Error for an unknown kind, for classes without names, and for values that no network of
/// the kind gives.
[[nodiscard]] NetworkExport identify_export(const NetworkSignature& signature,
                                            const std::vector<Tensor>& outputs,
                                            cv::Size input);

/// The quoted words of a list or dictionary, in their order: {0: 'person', 1: "driver's seat"}, as
/// usable_class_name() makes them.
[[nodiscard]] std::vector<std::string> quoted_words(std::string_view text);

}  // namespace stillmap
