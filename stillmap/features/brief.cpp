// SPDX-License-Identifier: Apache-2.0
#include "stillmap/features/brief.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "stillmap/features/brief_pattern.hpp"

namespace stillmap {
namespace {

// Half width of each row of the round patch.
constexpr std::array<int, kPatchRadiusPx + 1> kHalfWidths = [] {
  std::array<int, kPatchRadiusPx + 1> widths{};
  for (int v = 0; v <= kPatchRadiusPx; ++v) {
    int u = 0;
    while ((u + 1) * (u + 1) + v * v <= kPatchRadiusPx * kPatchRadiusPx) ++u;
    widths[static_cast<std::size_t>(v)] = u;
  }
  return widths;
}();

}  // namespace

float patch_orientation_deg(const cv::Mat1b& image, cv::Point at) {
  int moment_x = 0, moment_y = 0;
  for (int v = -kPatchRadiusPx; v <= kPatchRadiusPx; ++v) {
    const std::uint8_t* row = image.ptr(at.y + v) + at.x;
    const int half_width = kHalfWidths[static_cast<std::size_t>(std::abs(v))];
    int sum = 0;
    for (int u = -half_width; u <= half_width; ++u) {
      sum += row[u];
      moment_x += u * row[u];
    }
    moment_y += v * sum;
  }
  return cv::fastAtan2(static_cast<float>(moment_y), static_cast<float>(moment_x));
}

Descriptor rotated_brief(const cv::Mat1b& blurred, cv::Point at, float angle_deg) {
  const float angle = angle_deg * std::numbers::pi_v<float> / 180.0F;
  const float c = std::cos(angle), s = std::sin(angle);
  const std::uint8_t* center = blurred.ptr(at.y) + at.x;
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(blurred.step[0]);
  const auto value = [&](int x, int y) {
    const float fx = static_cast<float>(x), fy = static_cast<float>(y);
    return center[cvRound(s * fx + c * fy) * stride + cvRound(c * fx - s * fy)];
  };
  Descriptor descriptor{};
  for (std::size_t i = 0; i < kBriefPattern.size(); ++i) {
    const BriefTest& test = kBriefPattern[i];
    const bool darker = value(test.x0, test.y0) < value(test.x1, test.y1);
    descriptor[i / 64] |= static_cast<std::uint64_t>(darker) << (i % 64);
  }
  return descriptor;
}

}  // namespace stillmap
