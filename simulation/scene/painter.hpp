// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "simulation/scene/material.hpp"
#include "simulation/scene/pictures.hpp"
#include "simulation/scene/shapes.hpp"

namespace stillmap {

/// Hands out the surfaces of an office's things, each picture with a seed of its own.
class Painter {
 public:
  explicit Painter(std::uint32_t seed) : seed_(seed) {}

  [[nodiscard]] PictureSeed next_seed();

  [[nodiscard]] Surface plain(const cv::Vec3b& rgb) { return {materials_.add_plain(rgb)}; }
  [[nodiscard]] Surface glowing(const cv::Mat3b& picture, float glow) {
    return {materials_.add({MipTexture(picture), false, glow})};
  }
  [[nodiscard]] Surface picture(const cv::Mat3b& picture) { return glowing(picture, 0.F); }
  [[nodiscard]] Surface repeated(const cv::Mat3b& picture, double tile_m) {
    return {materials_.add({MipTexture(picture), true}), tile_m};
  }

  [[nodiscard]] MaterialLibrary take_materials() { return std::move(materials_); }

 private:
  std::uint32_t seed_;
  std::uint32_t pictures_ = 0;
  MaterialLibrary materials_;
};

/// Moved to a place and turned about the vertical.
[[nodiscard]] Eigen::Isometry3d placed(double x, double y, double z, double yaw_deg = 0);

}  // namespace stillmap
