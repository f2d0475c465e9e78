// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "simulation/scene/texture.hpp"

namespace stillmap {

/// The look of a surface. Texture coordinates (u, v): (0, 0) is the top left corner of the picture,
/// (1, 1) the bottom right.
struct Material {
  MipTexture texture;
  bool repeats = false;  ///< beyond [0, 1] the picture repeats; else its edge's colour continues
  float glow = 0.F;      ///< least apparent light on it, in [0, 1]: screens, lamps
};

/// A position in a MaterialLibrary.
using MaterialId = std::uint32_t;

/// The materials of a world.
class MaterialLibrary {
 public:
  MaterialId add(Material material) {
    materials_.push_back(std::move(material));
    return static_cast<MaterialId>(materials_.size() - 1);
  }

  /// One colour: red, green, blue.
  MaterialId add_plain(const cv::Vec3b& rgb) { return add({MipTexture(cv::Mat3b(1, 1, rgb))}); }

  [[nodiscard]] const Material& operator[](MaterialId id) const { return materials_[id]; }
  [[nodiscard]] std::size_t size() const { return materials_.size(); }

 private:
  std::vector<Material> materials_;
};

}  // namespace stillmap
