// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <random>

#include <opencv2/core/mat.hpp>
#include <opencv2/imgproc.hpp>

#include "stillmap/core/images.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/features/features.hpp"

// Seeded test data for this module's tests and benchmarks.
namespace stillmap {

class TestDice {
 public:
  explicit TestDice(std::uint32_t seed) : engine_(seed) {}

  std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }
  int integer(int low, int high) {  // both inclusive
    return low + static_cast<int>(bits() % static_cast<std::uint32_t>(high - low + 1));
  }
  float uniform(float low, float high) {
    return low + (high - low) * (static_cast<float>(bits()) / 4294967296.0F);
  }
  Eigen::Vector2f point(float low, float high_x, float high_y) {
    const float x = uniform(low, high_x);
    return {x, uniform(low, high_y)};
  }
  Descriptor descriptor() {
    Descriptor d{};
    for (std::uint64_t& word : d) word = (std::uint64_t{bits()} << 32U) | bits();
    return d;
  }
  /// The descriptor after `count` flips of random bits, some perhaps flipped back.
  Descriptor flipped(Descriptor d, int count) {
    for (int i = 0; i < count; ++i) {
      const std::uint32_t bit = bits() % 256;
      d[bit / 64] ^= std::uint64_t{1} << (bit % 64);
    }
    return d;
  }

 private:
  std::mt19937 engine_;
};

/// Overlapping random rectangles and discs, slightly blurred: corners at all scales.
inline GrayImage textured_image(int width, int height, std::uint32_t seed) {
  TestDice dice(seed);
  cv::Mat1b image(height, width, std::uint8_t{128});
  for (int i = 0; i < 2 * width * height / 1000; ++i) {
    const cv::Point at(dice.integer(-20, width), dice.integer(-20, height));
    const int size = dice.integer(4, 60), gray = dice.integer(0, 255);
    if (i % 3 == 0) {
      cv::circle(image, at, size / 2, gray, cv::FILLED);
    } else {
      cv::rectangle(image, cv::Rect(at, cv::Size(size, dice.integer(4, 60))), gray, cv::FILLED);
    }
  }
  cv::GaussianBlur(image, image, cv::Size(3, 3), 0.7);
  return GrayImage(image);
}

/// A camera without distortion for images of the given size.
inline CameraModel camera_of_size(int width, int height) {
  CameraModel camera;
  camera.width_px = width, camera.height_px = height;
  camera.fx = camera.fy = width;
  camera.cx = 0.5 * (width - 1), camera.cy = 0.5 * (height - 1);
  return camera;
}

}  // namespace stillmap
