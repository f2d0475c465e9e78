// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/feature_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stillmap {

FeatureGrid::FeatureGrid(std::span<const Eigen::Vector2f> points_px, int width_px, int height_px)
    : columns_(std::max(1, static_cast<int>(std::ceil(static_cast<float>(width_px) / kCellPx)))),
      rows_(std::max(1, static_cast<int>(std::ceil(static_cast<float>(height_px) / kCellPx)))),
      cell_begin_(static_cast<std::size_t>(columns_ * rows_) + 1, 0),
      indices_(points_px.size()) {
  // Counting sort: cell sizes, then cell begins, then the points by index.
  std::vector<std::uint32_t> cell_of(points_px.size());
  for (std::size_t i = 0; i < points_px.size(); ++i) {
    cell_of[i] =
        static_cast<std::uint32_t>(row(points_px[i].y()) * columns_ + column(points_px[i].x()));
    ++cell_begin_[cell_of[i] + 1];
  }
  std::partial_sum(cell_begin_.begin(), cell_begin_.end(), cell_begin_.begin());
  std::vector<std::uint32_t> next(cell_begin_.begin(), cell_begin_.end() - 1);
  for (std::size_t i = 0; i < points_px.size(); ++i) {
    indices_[next[cell_of[i]]++] = static_cast<std::uint32_t>(i);
  }
}

}  // namespace stillmap
