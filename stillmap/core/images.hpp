// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <opencv2/core/mat.hpp>

namespace stillmap {

// OpenCV converts silently between image types, and a copy of a const cv::Mat can change the
// original's pixels. Images therefore travel in these one-member structs, which do not convert into
// each other. A function never writes to an image that it was given.

/// Colour, 8 bits a channel, in the order red, green, blue.
struct ColorImage {
  cv::Mat3b mat;  ///< empty where there is no image
  ColorImage() = default;
  /// Shares the pixels.
  explicit ColorImage(cv::Mat3b rgb) : mat(std::move(rgb)) {}
};

/// Brightness, 8 bits.
struct GrayImage {
  cv::Mat1b mat;  ///< empty where there is no image
  GrayImage() = default;
  /// Shares the pixels.
  explicit GrayImage(cv::Mat1b gray) : mat(std::move(gray)) {}
};

/// Depth along the optical axis in metres; 0 where it is missing.
struct DepthImage {
  cv::Mat1f mat;  ///< empty where there is no image
  DepthImage() = default;
  /// Shares the pixels.
  explicit DepthImage(cv::Mat1f metres) : mat(std::move(metres)) {}
};

/// A set of pixels: 8 bits each, not 0 where the pixel is in the set. An empty image is the empty
/// set.
struct Mask {
  cv::Mat1b mat;  ///< not 0 where the pixel is in the set
  Mask() = default;
  /// Shares the pixels.
  explicit Mask(cv::Mat1b pixels) : mat(std::move(pixels)) {}

  /// Whether the set is empty for want of an image.
  [[nodiscard]] bool empty() const { return mat.empty(); }
  /// Whether the pixel is in the set.
  [[nodiscard]] bool covers(int row, int column) const { return !empty() && mat(row, column) != 0; }
};

/// Depth in metres at half the resolution of a depth image: cell (r, c) is pixel (2r, 2c). 0 where
/// nothing is known; an empty image knows nothing.
struct HalfDepth {
  cv::Mat1f mat;  ///< metres
  HalfDepth() = default;
  /// Shares the pixels.
  explicit HalfDepth(cv::Mat1f metres) : mat(std::move(metres)) {}

  /// Whether nothing is known of any pixel.
  [[nodiscard]] bool empty() const { return mat.empty(); }
};

}  // namespace stillmap
