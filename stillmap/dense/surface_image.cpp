// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/surface_image.hpp"

#include <algorithm>
#include <cmath>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr int kReach = 2;              // cells between which changes are measured
constexpr float kSameChange = 0.004F;  // 1/m; of the noise of the inverse depth, some deviations
constexpr float kOccupied = -1.0F;     // more than one surface

int cells_over(int pixels, int cell_px) {
  return (pixels + cell_px - 1) / cell_px;
}

/// The change for one cell, from those to the cells before and after, where these are known.
float change(float before, float here, float after) {
  const float left = here - before, right = after - here;
  if (before <= 0 && after <= 0) return 0;
  if (before <= 0) return right / kReach;
  if (after <= 0) return left / kReach;
  if (std::abs(left - right) <= kSameChange) return 0.5F * (left + right) / kReach;
  return (std::abs(left) < std::abs(right) ? left : right) / kReach;
}

void measure_changes(SurfaceImage& image) {
  const auto depth_at = [&image](int row, int column) {
    const bool inside = row >= 0 && column >= 0 && row < image.rows && column < image.columns;
    return inside ? image.at(row, column).inverse_depth : 0.0F;
  };
  const float per_px = 1.0F / static_cast<float>(image.cell_px);
  std::size_t i = 0;
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column, ++i) {
      SurfaceCell& cell = image.cells[i];
      const float here = cell.inverse_depth;
      if (here <= 0) continue;
      cell.per_column =
          per_px * change(depth_at(row, column - kReach), here, depth_at(row, column + kReach));
      cell.per_row =
          per_px * change(depth_at(row - kReach, column), here, depth_at(row + kReach, column));
    }
  }
}

}  // namespace

SurfaceImage surface_image(const CompactCloud& view, const CameraModel& camera, int cell_px) {
  STILLMAP_CHECK(cell_px > 0);
  SurfaceImage image;
  image.cell_px = cell_px;
  image.columns = cells_over(camera.width_px, cell_px);
  image.rows = cells_over(camera.height_px, cell_px);
  image.cells.resize(static_cast<std::size_t>(image.columns) *
                     static_cast<std::size_t>(image.rows));
  for (std::size_t i = 0; i < view.size(); ++i) {
    const Eigen::Vector3d p = view.position(i).cast<double>();
    if (!(p.z() > 0)) continue;
    const Eigen::Vector2d raw = camera.distort(camera.project(p));
    const int column = static_cast<int>(std::lround(raw.x())) / cell_px;
    const int row = static_cast<int>(std::lround(raw.y())) / cell_px;
    if (column < 0 || row < 0 || column >= image.columns || row >= image.rows) continue;
    float& cell =
        image
            .cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.columns) +
                   static_cast<std::size_t>(column)]
            .inverse_depth;
    cell = cell == 0 ? static_cast<float>(1 / p.z()) : kOccupied;
  }
  for (SurfaceCell& cell : image.cells) cell.inverse_depth = std::max(cell.inverse_depth, 0.0F);
  measure_changes(image);
  return image;
}

}  // namespace stillmap
