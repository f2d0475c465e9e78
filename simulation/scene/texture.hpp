// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace stillmap {

/// A colour in fixed point: red, green, blue in 255ths, times 256.
using TexelSum = std::array<std::uint32_t, 3>;

/// A place on a texture: (0, 0) is the corner of the first texel, (1, 1) that of the last.
struct TexturePoint {
  float u = 0;
  float v = 0;
};

/// A picture on a rectangle with a pyramid of halved copies, so that it can be sampled without
/// aliasing from any distance. Outside the rectangle the edge's colour continues, or the picture
/// repeats, as the caller chooses.
class MipTexture {
 public:
  /// `base` is red, green, blue; its columns and rows cover the whole rectangle.
  explicit MipTexture(const cv::Mat3b& base);

  /// Colour at a place, averaged over about 2^level texels of the base across; level < 0 means
  /// magnified. Linear in place and level. `repeats`: the picture repeats beyond its edges.
  [[nodiscard]] TexelSum sample(const TexturePoint& at, float level, bool repeats = false) const;

  /// The sum of samples at four places at most 2^level texels from one another. The coarser of the
  /// two levels that are blended is looked up in the places' middle alone: it varies little there.
  [[nodiscard]] TexelSum sample_four(const std::array<TexturePoint, 4>& at,
                                     float level,
                                     bool repeats = false) const;

  [[nodiscard]] int width() const { return levels_.front().width; }
  [[nodiscard]] int height() const { return levels_.front().height; }

 private:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<std::uint32_t> texels;  // 0x00BBGGRR
  };

  // The levels to blend: levels_[fine] and, where share > 0, share / 256 of levels_[fine + 1].
  struct Blend {
    std::size_t fine;
    std::uint32_t share;
  };

  [[nodiscard]] static Level pack(const cv::Mat3b& picture);
  [[nodiscard]] static TexelSum sample_level(const Level& level,
                                             const TexturePoint& at,
                                             bool repeats);
  [[nodiscard]] Blend blend_at(float level) const;

  std::vector<Level> levels_;
};

}  // namespace stillmap
