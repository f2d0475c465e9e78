// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// An axis-aligned rectangle [x0, x1) x [y0, y1) in pixels: the pixel in column u and row v covers
/// [u, u + 1) x [v, v + 1). It may reach beyond the image.
struct PixelBox {
  /// Left, upper, right and lower edge.
  /// @{
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  /// @}

  /// Pixels from left to right.
  [[nodiscard]] double width() const { return x1 - x0; }
  /// Pixels from top to bottom.
  [[nodiscard]] double height() const { return y1 - y0; }
  /// Width times height.
  [[nodiscard]] double area() const { return width() * height(); }
  /// Exact equality of all edges.
  bool operator==(const PixelBox&) const = default;
};

/// Where the pixels of an object come from.
enum class PixelSource : std::uint8_t {
  kNetwork,       ///< a network that knows outlines, or a person; also where there are no pixels
  kRoughNetwork,  ///< a network that sees one box and little of what surrounds it: outlines by
                  ///< depth are better
  kDepth,         ///< depth in the box, because the network gave the box alone
};

/// An object that a network, or a substitute for one, found in an image.
struct DetectedObject {
  int id = 0;              ///< 1 to 255, unique in its frame; unrelated to ids in other frames
  std::string class_name;  ///< the COCO name if there is one
  float score = 0;         ///< confidence of the network, in [0, 1]
  PixelBox box;            ///< not empty
  PixelSource pixel_source = PixelSource::kNetwork;  ///< of its pixels

  /// Exact equality of all members.
  bool operator==(const DetectedObject&) const = default;
};

/// The object of each pixel: 8 bits, the id of an object, or 0. Like the images of core/images.hpp,
/// it is never written to by a function that was given one.
struct ObjectMask {
  cv::Mat1b mat;  ///< empty where no object has pixels
  ObjectMask() = default;
  /// Shares the pixels.
  explicit ObjectMask(cv::Mat1b ids) : mat(std::move(ids)) {}
};

/// The detections of one colour image.
struct FrameDetections {
  Stamp stamp;                          ///< of the colour image
  std::vector<DetectedObject> objects;  ///< in the order of the network or the file
  ObjectMask mask;                      ///< as large as the image; empty where no object has pixels
};

}  // namespace stillmap
