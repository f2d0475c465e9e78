// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "stillmap/dense/compact_cloud.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// The surface that a view measures in one cell of the image: a plane there, as the inverse of
/// depth, which is linear over the image on a plane.
struct SurfaceCell {
  float inverse_depth = 0;  ///< 1/m, at the middle of the cell; 0: no surface, or more than one
  float per_column = 0;     ///< change of the inverse depth for a pixel to the right
  float per_row = 0;        ///< and for a pixel downwards

  [[nodiscard]] bool known() const { return inverse_depth > 0; }
};

/// The static surface of a view as an image of square cells of pixels.
struct SurfaceImage {
  int cell_px = 1;
  int columns = 0, rows = 0;
  std::vector<SurfaceCell> cells;  ///< row by row

  [[nodiscard]] const SurfaceCell& at(int row, int column) const {
    return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)];
  }
};

/// The surface of a view from its points, one or more for each cell (see local_cloud()). A cell
/// with points of two surfaces is unknown. The change over the image is that between cells two
/// apart, on the side where it is least, or on both if they agree.
[[nodiscard]] SurfaceImage surface_image(const CompactCloud& view,
                                         const CameraModel& camera,
                                         int cell_px);

}  // namespace stillmap
