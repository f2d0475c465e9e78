// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/pixels.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace stillmap::python {
namespace {

// Whether all are finite and their sign is +. Of the bits of such a number as an integer the
// highest is 0, and stays 0 when the exponent grows by 1, which makes the highest bit 1 where all
// bits of the exponent were. Compilers make this loop as fast as memory is.
bool all_measured_or_zero(const cv::Mat1f& metres) {
  constexpr std::uint32_t kOneInExponent = 1U << 23U;
  for (int v = 0; v < metres.rows; ++v) {
    const float* row = metres[v];
    std::uint32_t odd = 0;
    for (int u = 0; u < metres.cols; ++u) {
      const auto bits = std::bit_cast<std::uint32_t>(row[u]);
      odd |= bits | (bits + kOneInExponent);
    }
    if (odd >> 31U != 0) return false;
  }
  return true;
}

}  // namespace

cv::Mat1f with_missing_as_zero(const cv::Mat1f& metres) {
  if (all_measured_or_zero(metres)) return metres;
  cv::Mat1f result = metres.clone();
  for (float& z : result) {
    if (!(z > 0.0F) || !std::isfinite(z)) z = 0.0F;
  }
  return result;
}

cv::Mat1f in_metres(const cv::Mat1w& units, double depth_factor) {
  cv::Mat1f metres(units.size());
  const auto factor = static_cast<float>(depth_factor);
  for (int v = 0; v < units.rows; ++v) {
    const std::uint16_t* source = units[v];
    float* target = metres[v];
    for (int u = 0; u < units.cols; ++u) target[u] = static_cast<float>(source[u]) / factor;
  }
  return metres;
}

void paint(cv::Mat1b& ids, const std::uint8_t* mask, std::uint8_t id) {
  for (int v = 0; v < ids.rows; ++v) {
    std::uint8_t* row = ids[v];
    for (int u = 0; u < ids.cols; ++u) row[u] = *mask++ != 0 ? id : row[u];
  }
}

FrameDetections numbered_in_order(const FrameDetections& found) {
  FrameDetections result = found;
  std::array<std::uint8_t, 256> place{};
  for (std::size_t i = 0; i < found.objects.size(); ++i) {
    const auto id = static_cast<std::uint8_t>(i + 1);
    place.at(static_cast<std::size_t>(found.objects[i].id)) = id;
    result.objects[i].id = id;
  }
  result.mask.mat = found.mask.mat.clone();
  for (std::uint8_t& id : result.mask.mat) id = place[id];
  return result;
}

std::vector<PixelBox> boxes_around(const cv::Mat1b& ids, std::size_t count) {
  constexpr double kFar = std::numeric_limits<double>::max();
  std::vector<PixelBox> boxes(count, {kFar, kFar, 0, 0});
  for (int v = 0; v < ids.rows; ++v) {
    for (int u = 0; u < ids.cols; ++u) {
      if (ids(v, u) == 0 || ids(v, u) > count) continue;
      PixelBox& box = boxes[static_cast<std::size_t>(ids(v, u)) - 1];
      box.x0 = std::min(box.x0, static_cast<double>(u));
      box.y0 = std::min(box.y0, static_cast<double>(v));
      box.x1 = std::max(box.x1, u + 1.0);
      box.y1 = std::max(box.y1, v + 1.0);
    }
  }
  for (PixelBox& box : boxes) box = box.x1 > 0 ? box : PixelBox{};
  return boxes;
}

}  // namespace stillmap::python
