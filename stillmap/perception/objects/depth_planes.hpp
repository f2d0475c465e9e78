// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace stillmap {

/// A grid of depths, row by row, metres; 0 where there is none. Columns and rows are equally far
/// apart in the image.
struct DepthCells {
  std::span<const float> depth_m;
  int columns = 0, rows = 0;
};

/// The cells of one plane, connected by their sides: their numbers, row by row, in no order.
using PlanarPart = std::vector<int>;

/// The planar parts of a depth image of a camera without distortion. A part grows from three by
/// three cells, cell by cell, while the depth of the plane through it, which is fitted again
/// whenever the part has doubled, is within 1 cm + 0.4 cm z^2 of the cell's. Inverse depth is
/// linear in the image over a plane. Each cell is in one part at most. Parts of fewer than `least`
/// cells are left out, and curved ones: those in which the root mean square of the differences,
/// each as a share of the greatest there may be, is more than 0.4; noise makes 0.25 to 0.35.
[[nodiscard]] std::vector<PlanarPart> planar_parts(const DepthCells& cells, std::size_t least);

}  // namespace stillmap
