// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/brief.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "stillmap/core/vector_clones.hpp"
#include "stillmap/slam/features/brief_pattern.hpp"

namespace stillmap {
namespace {

// The half width of each row of the round patch.
constexpr std::array<int, kPatchRadiusPx + 1> kHalfWidths = [] {
  std::array<int, kPatchRadiusPx + 1> widths{};
  for (int v = 0; v <= kPatchRadiusPx; ++v) {
    int u = 0;
    while ((u + 1) * (u + 1) + v * v <= kPatchRadiusPx * kPatchRadiusPx) ++u;
    widths[static_cast<std::size_t>(v)] = u;
  }
  return widths;
}();

// The square around the patch, row by row, padded by one column to whole vectors.
constexpr std::size_t kPatchSide = 2 * kPatchRadiusPx + 1, kPatchStride = kPatchSide + 1;
constexpr std::size_t kPatchCells = kPatchSide * kPatchStride;

// Distances from the centre, 0 outside the round patch.
struct Moments {
  std::array<std::int16_t, kPatchCells> x{}, y{};
};

constexpr Moments kMoments = [] {
  Moments moments;
  for (int v = -kPatchRadiusPx; v <= kPatchRadiusPx; ++v) {
    const int half_width = kHalfWidths[static_cast<std::size_t>(v < 0 ? -v : v)];
    for (int u = -half_width; u <= half_width; ++u) {
      const auto cell = static_cast<std::size_t>(v + kPatchRadiusPx) * kPatchStride +
                        static_cast<std::size_t>(u + kPatchRadiusPx);
      moments.x[cell] = static_cast<std::int16_t>(u);
      moments.y[cell] = static_cast<std::int16_t>(v);
    }
  }
  return moments;
}();

// The points of the pattern, in an order that the compiler can vectorise.
struct PatternPoints {
  std::array<float, 2 * kBriefPattern.size()> x{}, y{};
};

constexpr PatternPoints kPatternPoints = [] {
  PatternPoints points;
  for (std::size_t i = 0; i < kBriefPattern.size(); ++i) {
    points.x[2 * i] = kBriefPattern[i].x0;
    points.y[2 * i] = kBriefPattern[i].y0;
    points.x[2 * i + 1] = kBriefPattern[i].x1;
    points.y[2 * i + 1] = kBriefPattern[i].y1;
  }
  return points;
}();

// Rounds to the nearest whole number, halves to even, for |value| < 2^22: the sum has no bits for
// fractions. Unlike a call of std::round, this vectorises.
float rounded(float value) {
  constexpr float kShift = 12582912.0F;  // 1.5 * 2^23
  return (value + kShift) - kShift;
}

}  // namespace

STILLMAP_VECTOR_CLONES
float patch_orientation_deg(const cv::Mat1b& image, cv::Point at) {
  std::array<std::uint8_t, kPatchCells> patch{};
  for (std::size_t v = 0; v < kPatchSide; ++v) {
    const int row = at.y + static_cast<int>(v) - kPatchRadiusPx;
    std::memcpy(&patch[v * kPatchStride], image.ptr(row) + at.x - kPatchRadiusPx, kPatchSide);
  }
  int moment_x = 0, moment_y = 0;
  for (std::size_t i = 0; i < kPatchCells; ++i) {
    moment_x += kMoments.x[i] * static_cast<std::int16_t>(patch[i]);
    moment_y += kMoments.y[i] * static_cast<std::int16_t>(patch[i]);
  }
  return cv::fastAtan2(static_cast<float>(moment_y), static_cast<float>(moment_x));
}

STILLMAP_VECTOR_CLONES
Descriptor rotated_brief(const cv::Mat1b& blurred, cv::Point at, float angle_deg) {
  const float angle = angle_deg * std::numbers::pi_v<float> / 180.0F;
  const float c = std::cos(angle), s = std::sin(angle);
  const float stride = static_cast<float>(blurred.step[0]);
  std::array<std::int32_t, kPatternPoints.x.size()> offsets;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const float x = kPatternPoints.x[i], y = kPatternPoints.y[i];
    offsets[i] =
        static_cast<std::int32_t>(rounded(s * x + c * y) * stride + rounded(c * x - s * y));
  }
  const std::uint8_t* center = blurred.ptr(at.y) + at.x;
  Descriptor descriptor{};
  const std::int32_t* pair = offsets.data();
  for (std::uint64_t& word : descriptor) {
    std::uint64_t bits = 0;
    for (unsigned bit = 0; bit < 64; ++bit, pair += 2) {
      bits |= static_cast<std::uint64_t>(center[pair[0]] < center[pair[1]]) << bit;
    }
    word = bits;
  }
  return descriptor;
}

}  // namespace stillmap
