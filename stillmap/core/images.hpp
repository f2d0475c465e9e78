// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

namespace stillmap {

// OpenCV converts silently between image types, and a copy of a const cv::Mat can change the
// original's pixels. Images therefore travel in these one-member structs, which do not convert into
// each other. A function never writes to an image that it was given.

/// Colour, 8 bits a channel, in the order red, green, blue.
struct ColorImage {
  cv::Mat3b mat;
  ColorImage() = default;
  explicit ColorImage(cv::Mat3b rgb) : mat(std::move(rgb)) {}
};

/// Brightness, 8 bits.
struct GrayImage {
  cv::Mat1b mat;
  GrayImage() = default;
  explicit GrayImage(cv::Mat1b gray) : mat(std::move(gray)) {}
};

/// Depth along the optical axis in metres; 0 where it is missing.
struct DepthImage {
  cv::Mat1f mat;
  DepthImage() = default;
  explicit DepthImage(cv::Mat1f metres) : mat(std::move(metres)) {}
};

}  // namespace stillmap
