// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include <opencv2/core/types.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/perception/detections/detections.hpp"

namespace stillmap {

/// Finds objects in colour images: a network, or what one has found before. segment() may be called
/// from several threads; a frame's result depends on nothing but that frame.
class Segmenter {
 public:
  Segmenter() = default;
  Segmenter(const Segmenter&) = delete;
  Segmenter& operator=(const Segmenter&) = delete;
  virtual ~Segmenter() = default;

  /// The objects in an image, with its stamp. The image has the size that the segmenter was made
  /// for. Throws Error when a file or a network fails.
  [[nodiscard]] virtual FrameDetections segment(const ColorImage& color,
                                                const Stamp& stamp) const = 0;
};

struct SegmenterOptions {
  int threads = 2;  ///< for one run of a network
};

/// A segmenter by its description: `detections:DIR`, a folder of detections; `onnx:MODEL.onnx`, one
/// network (see ExportKind); `auto` or `onnx:auto`, the networks that tools/fetch_models gets.
/// `image` is the size of the images. Throws Error, in one line with what is missing and what to
/// do, when the description is none of these or what it names is not there.
[[nodiscard]] std::unique_ptr<Segmenter> make_segmenter(std::string_view description,
                                                        cv::Size image,
                                                        const SegmenterOptions& options = {});

}  // namespace stillmap
