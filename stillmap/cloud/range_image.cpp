// SPDX-License-Identifier: Apache-2.0
#include "stillmap/cloud/range_image.hpp"

#include <algorithm>
#include <limits>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr std::uint16_t kUnknown = std::numeric_limits<std::uint16_t>::max();  // no minimum
constexpr float kFarthest = 65.0F;  // metres, that fits into 16 bits of millimetres

/// The least depth of a block's pixels, or kUnknown.
std::uint16_t block_range(const cv::Mat1f& depth,
                          const cv::Mat1b& dynamic,
                          const cv::Rect& block,
                          double max_missing) {
  float nearest = kFarthest;
  int known = 0;
  for (int row = block.y; row < block.y + block.height; ++row) {
    const float* z = depth[row];
    for (int x = block.x; x < block.x + block.width; ++x) {
      if (!dynamic.empty() && dynamic(row, x) != 0) return kUnknown;
      if (!(z[x] > 0)) continue;
      nearest = std::min(nearest, z[x]);
      ++known;
    }
  }
  const bool enough = known > 0 && block.area() - known <= max_missing * block.area();
  return enough ? static_cast<std::uint16_t>(nearest * 1000.0F) : kUnknown;
}

/// The least of each `2 reach + 1` neighbours in a row; kUnknown stays it.
void spread_rows(cv::Mat1w& range, int reach) {
  cv::Mat1w line(1, range.cols);
  for (int row = 0; row < range.rows; ++row) {
    std::uint16_t* cell = range[row];
    std::copy(cell, cell + range.cols, line[0]);
    for (int x = 0; x < range.cols; ++x) {
      if (cell[x] == kUnknown) continue;
      const int begin = std::max(0, x - reach), end = std::min(range.cols, x + reach + 1);
      cell[x] = *std::min_element(line[0] + begin, line[0] + end);
    }
  }
}

void spread_columns(cv::Mat1w& range, int reach) {
  const cv::Mat1w before = range.clone();
  for (int row = 0; row < range.rows; ++row) {
    std::uint16_t* cell = range[row];
    for (int r = std::max(0, row - reach); r < std::min(range.rows, row + reach + 1); ++r) {
      const std::uint16_t* other = before[r];
      for (int x = 0; x < range.cols; ++x) {
        cell[x] = cell[x] == kUnknown ? kUnknown : std::min(cell[x], other[x]);
      }
    }
  }
}

}  // namespace

RangeImage range_image(const cv::Mat1f& depth,
                       const cv::Mat1b& dynamic,
                       const RangeImageConfig& config) {
  STILLMAP_CHECK(dynamic.empty() || dynamic.size() == depth.size());
  STILLMAP_CHECK(config.block_px > 0 && config.rim_blocks >= 0);
  const int side = config.block_px;
  RangeImage range{cv::Mat1w((depth.rows + side - 1) / side, (depth.cols + side - 1) / side), side};
  for (int row = 0; row < range.millimetres.rows; ++row) {
    for (int x = 0; x < range.millimetres.cols; ++x) {
      const cv::Rect block(x * side,
                           row * side,
                           std::min(side, depth.cols - x * side),
                           std::min(side, depth.rows - row * side));
      range.millimetres(row, x) = block_range(depth, dynamic, block, config.max_missing);
    }
  }
  spread_rows(range.millimetres, config.rim_blocks);
  spread_columns(range.millimetres, config.rim_blocks);
  for (std::uint16_t& mm : range.millimetres) mm = mm == kUnknown ? std::uint16_t{0} : mm;
  return range;
}

}  // namespace stillmap
