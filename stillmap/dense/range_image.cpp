// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/range_image.hpp"

#include <algorithm>
#include <limits>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr float kNothing = std::numeric_limits<float>::max();

/// Nearest depth of the pixels of a block; kNothing where nothing is known.
struct BlockDepth {
  float still = kNothing;
  float moving = kNothing;
  bool excluded = false;  // some of them
};

BlockDepth block_depth(const cv::Mat1f& depth,
                       const DynamicRegions& dynamic_regions,
                       const cv::Rect& block,
                       double max_missing) {
  BlockDepth nearest;
  int missing = 0;
  for (int row = block.y; row < block.y + block.height; ++row) {
    const float* z = depth[row];
    const std::uint8_t* excluded =
        dynamic_regions.excluded.empty() ? nullptr : dynamic_regions.excluded.mat[row];
    const std::uint8_t* moving =
        dynamic_regions.moving.empty() ? nullptr : dynamic_regions.moving.mat[row];
    for (int x = block.x; x < block.x + block.width; ++x) {
      const bool moves = moving != nullptr && moving[x] != 0;
      nearest.excluded |= moves || (excluded != nullptr && excluded[x] != 0);
      if (z[x] > 0) {
        float& least = moves ? nearest.moving : nearest.still;
        least = std::min(least, z[x]);
      } else {
        ++missing;
      }
    }
  }
  if (nearest.excluded || missing > max_missing * block.area()) nearest.still = kNothing;
  return nearest;
}

/// For each known value, the least of those up to `reach` away in its row.
void spread_rows(cv::Mat1f& range, int reach) {
  cv::Mat1f line(1, range.cols);
  for (int row = 0; row < range.rows; ++row) {
    float* cell = range[row];
    std::copy(cell, cell + range.cols, line[0]);
    for (int x = 0; x < range.cols; ++x) {
      const int begin = std::max(0, x - reach), end = std::min(range.cols, x + reach + 1);
      if (cell[x] < kNothing) cell[x] = *std::min_element(line[0] + begin, line[0] + end);
    }
  }
}

void spread_columns(cv::Mat1f& range, int reach) {
  const cv::Mat1f before = range.clone();
  for (int row = 0; row < range.rows; ++row) {
    float* cell = range[row];
    for (int r = std::max(0, row - reach); r < std::min(range.rows, row + reach + 1); ++r) {
      const float* other = before[r];
      for (int x = 0; x < range.cols; ++x) {
        cell[x] = cell[x] < kNothing ? std::min(cell[x], other[x]) : kNothing;
      }
    }
  }
}

}  // namespace

RangeCell::RangeCell(float range_m, bool moving)
    : bits_(static_cast<std::uint16_t>(
          static_cast<std::uint16_t>(std::clamp(range_m, kUnit_m, 65.0F) / kUnit_m) |
          (moving ? kMoving : 0))) {}

RangeImage range_image(const cv::Mat1f& depth,
                       const DynamicRegions& dynamic_regions,
                       const RangeImageConfig& config) {
  for (const Mask& mask : {dynamic_regions.excluded, dynamic_regions.moving}) {
    STILLMAP_CHECK(mask.empty() || mask.mat.size() == depth.size());
  }
  STILLMAP_CHECK(config.block_px > 0 && config.rim_blocks >= 0);
  const int side = config.block_px;
  RangeImage image{side, (depth.cols + side - 1) / side, (depth.rows + side - 1) / side, {}};
  image.cells.resize(static_cast<std::size_t>(image.rows) *
                     static_cast<std::size_t>(image.columns));
  cv::Mat1f still(image.rows, image.columns, kNothing);
  for (int row = 0; row < image.rows; ++row) {
    for (int x = 0; x < image.columns; ++x) {
      const cv::Rect block(x * side,
                           row * side,
                           std::min(side, depth.cols - x * side),
                           std::min(side, depth.rows - row * side));
      const BlockDepth nearest = block_depth(depth, dynamic_regions, block, config.max_missing);
      still(row, x) = nearest.still;
      if (nearest.moving < kNothing) {
        const auto i = static_cast<std::size_t>(row * image.columns + x);
        image.cells[i] = RangeCell(nearest.moving, true);
      }
    }
  }
  spread_rows(still, config.rim_blocks);
  spread_columns(still, config.rim_blocks);
  for (std::size_t i = 0; i < image.cells.size(); ++i) {
    const float range = *(still[0] + i);
    if (range < kNothing) image.cells[i] = RangeCell(range, false);
  }
  return image;
}

}  // namespace stillmap
