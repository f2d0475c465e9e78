// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include <opencv2/core/types.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/perception/detections/detections.hpp"

namespace stillmap {

/// Finds objects in colour images: by a network, or from a folder of its earlier results. segment()
/// may be called from several threads; the result of a frame depends on that frame alone.
class Segmenter {
 public:
  Segmenter() = default;
  Segmenter(const Segmenter&) = delete;
  Segmenter& operator=(const Segmenter&) = delete;
  virtual ~Segmenter() = default;

  /// The objects in an image, with its stamp. The image must have the size that the segmenter was
  /// made for. Throws Error when a file or a network fails.
  [[nodiscard]] virtual FrameDetections segment(const ColorImage& color,
                                                const Stamp& stamp) const = 0;
};

/// Options of a segmenter.
struct SegmenterOptions {
  int threads = 2;  ///< number of threads for one run of a network
  /// The names of the images' files without their extension, by the text of the images' stamps:
  /// masks may be named after them. Images that are not listed are identified by their stamp.
  std::map<std::string, std::string> image_names = {};
};

/// Makes a segmenter from its description: `detections:DIR`, a folder of detections; `masks:DIR`, a
/// folder of plain masks of people (see MaskFolder); `onnx:MODEL.onnx`, one network (see
/// ExportKind); `auto` or `onnx:auto`, the networks that tools/fetch_models gets. `image` is the
/// size of the images. Throws Error, in one line with advice, for any other description and for
/// missing files.
[[nodiscard]] std::unique_ptr<Segmenter> make_segmenter(std::string_view description,
                                                        cv::Size image,
                                                        const SegmenterOptions& options = {});

}  // namespace stillmap
