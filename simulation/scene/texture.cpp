// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/texture.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"

namespace stillmap {

MipTexture::MipTexture(const cv::Mat3b& base) {
  STILLMAP_CHECK(!base.empty());
  cv::Mat3b picture = base;
  levels_.push_back(pack(picture));
  while (picture.cols > 1 || picture.rows > 1) {
    const cv::Size half((picture.cols + 1) / 2, (picture.rows + 1) / 2);
    cv::Mat3b smaller;
    cv::resize(picture, smaller, half, 0, 0, cv::INTER_AREA);
    picture = smaller;
    levels_.push_back(pack(picture));
  }
}

MipTexture::Level MipTexture::pack(const cv::Mat3b& picture) {
  Level level;
  level.width = picture.cols;
  level.height = picture.rows;
  level.texels.reserve(picture.total());
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec3b& rgb = picture(y, x);
      const std::uint32_t red = rgb[0], green = rgb[1], blue = rgb[2];
      level.texels.push_back(red | (green << 8U) | (blue << 16U));
    }
  }
  return level;
}

namespace {

// Two neighbouring texels in one direction, and a position between them.
struct Span {
  std::size_t first;
  std::size_t second;
  std::uint32_t part;  // of 256, from first to second
};

Span span_at(float normalized, int size, bool repeats) {
  float texels = normalized * static_cast<float>(size) - 0.5F;
  if (repeats) {
    const float periods = std::floor(normalized);
    texels -= periods * static_cast<float>(size);
    if (texels < 0.F) texels += static_cast<float>(size);
  }
  const float last = static_cast<float>(repeats ? size : size - 1);
  const float inside = texels < last ? std::max(texels, 0.F) : last;  // NaN: the last
  const int fixed = static_cast<int>(inside * 256.F);
  const int whole = std::min(fixed >> 8, size - 1);
  const int next = whole + 1 < size ? whole + 1 : repeats ? 0 : whole;
  return {static_cast<std::size_t>(whole),
          static_cast<std::size_t>(next),
          static_cast<std::uint32_t>(fixed & 255)};
}

}  // namespace

inline TexelSum MipTexture::sample_level(const Level& level, const TexturePoint& at, bool repeats) {
  const Span x = span_at(at.u, level.width, repeats);
  const Span y = span_at(at.v, level.height, repeats);
  const std::size_t width = static_cast<std::size_t>(level.width);
  const std::uint32_t* upper = level.texels.data() + y.first * width;
  const std::uint32_t* lower = level.texels.data() + y.second * width;
  const std::uint32_t a = upper[x.first], b = upper[x.second], c = lower[x.first],
                      d = lower[x.second];

  const std::uint32_t wd = (x.part * y.part) >> 8U;
  const std::uint32_t wb = x.part - wd, wc = y.part - wd;
  const std::uint32_t wa = 256U - wd - wb - wc;
  // Red and blue are weighted at once: 8 bits times 256 fit into the 16 bits that each has.
  constexpr std::uint32_t kRedBlue = 0x00ff00ffU;
  const std::uint32_t red_blue =
      (a & kRedBlue) * wa + (b & kRedBlue) * wb + (c & kRedBlue) * wc + (d & kRedBlue) * wd;
  const std::uint32_t green = ((a >> 8U) & 255U) * wa + ((b >> 8U) & 255U) * wb +
                              ((c >> 8U) & 255U) * wc + ((d >> 8U) & 255U) * wd;
  return {red_blue & 0xffffU, green, red_blue >> 16U};
}

inline MipTexture::Blend MipTexture::blend_at(float level) const {
  const float last = static_cast<float>(levels_.size() - 1);
  const float clamped = level < last ? std::max(level, 0.F) : last;  // NaN: the last
  const int fixed = static_cast<int>(clamped * 256.F);
  return {static_cast<std::size_t>(fixed >> 8), static_cast<std::uint32_t>(fixed & 255)};
}

TexelSum MipTexture::sample(const TexturePoint& at, float level, bool repeats) const {
  const Blend blend = blend_at(level);
  TexelSum sum = sample_level(levels_[blend.fine], at, repeats);
  if (blend.share == 0) return sum;
  const TexelSum coarse = sample_level(levels_[blend.fine + 1], at, repeats);
  for (std::size_t i = 0; i < 3; ++i) {
    sum[i] = (sum[i] * (256U - blend.share) + coarse[i] * blend.share) >> 8U;
  }
  return sum;
}

TexelSum MipTexture::sample_four(const std::array<TexturePoint, 4>& at,
                                 float level,
                                 bool repeats) const {
  const Blend blend = blend_at(level);
  TexelSum sum{};
  TexturePoint middle;
  for (const TexturePoint& point : at) {
    const TexelSum fine = sample_level(levels_[blend.fine], point, repeats);
    for (std::size_t i = 0; i < 3; ++i) sum[i] += fine[i];
    middle.u += 0.25F * point.u;
    middle.v += 0.25F * point.v;
  }
  if (blend.share == 0) return sum;
  const TexelSum coarse = sample_level(levels_[blend.fine + 1], middle, repeats);
  for (std::size_t i = 0; i < 3; ++i) {
    sum[i] = (sum[i] * (256U - blend.share) + 4U * coarse[i] * blend.share) >> 8U;
  }
  return sum;
}

}  // namespace stillmap
