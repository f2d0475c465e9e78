// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace stillmap {

/// Points of the image plane, sorted into square cells for radius queries.
class FeatureGrid {
 public:
  FeatureGrid() = default;

  /// Points outside the image, where undistortion moves some, belong to the cells at its border.
  FeatureGrid(std::span<const Eigen::Vector2f> points_px, int width_px, int height_px);

  /// Calls `visit(index)` for every point whose cell touches the square of half side `radius_px`
  /// around `center_px`: all points within the radius and some farther ones. Cells are visited row
  /// by row, points of a cell by index.
  template <class Visitor>
  void visit_near(const Eigen::Vector2f& center_px, float radius_px, Visitor&& visit) const {
    if (cell_begin_.empty()) return;
    const int c0 = column(center_px.x() - radius_px), c1 = column(center_px.x() + radius_px);
    const int r0 = row(center_px.y() - radius_px), r1 = row(center_px.y() + radius_px);
    for (int r = r0; r <= r1; ++r) {
      // The cells of a row are consecutive in memory: one run of indices.
      const std::uint32_t begin = cell_begin_[static_cast<std::size_t>(r * columns_ + c0)];
      const std::uint32_t end = cell_begin_[static_cast<std::size_t>(r * columns_ + c1) + 1];
      for (std::uint32_t i = begin; i < end; ++i) visit(indices_[i]);
    }
  }

 private:
  static constexpr float kCellPx = 16.0F;

  [[nodiscard]] int column(float x) const { return clamp_cell(x, columns_); }
  [[nodiscard]] int row(float y) const { return clamp_cell(y, rows_); }
  [[nodiscard]] static int clamp_cell(float position_px, int cells) {
    const float cell = position_px / kCellPx;
    if (!(cell > 0.0F)) return 0;
    return cell >= static_cast<float>(cells) ? cells - 1 : static_cast<int>(cell);
  }

  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> cell_begin_;  // begin of each cell in indices_, and the end
  std::vector<std::uint32_t> indices_;
};

}  // namespace stillmap
