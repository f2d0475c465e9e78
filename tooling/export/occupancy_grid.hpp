// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "tooling/export/observed_space.hpp"

namespace stillmap {

enum class GridCell : std::uint8_t { kUnknown, kFree, kOccupied };

/// The ground as square cells, seen from above, in the coordinate frame of floor_frame().
struct OccupancyGrid {
  int width = 0;   ///< cells along x
  int height = 0;  ///< cells along y
  double resolution_m = 0.05;
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();  ///< lower left corner of cell (0, 0)
  std::vector<GridCell> cells;                         ///< row by row, the lowest y first

  [[nodiscard]] GridCell at(int x, int y) const {
    return cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(x)];
  }
};

/// The interval of heights above the floor in which surface is an obstacle for a robot.
struct HeightBand {
  double min_m = 0.1;
  double max_m = 1.8;
};

/// The navigation grid from points and cameras in the floor's coordinate frame (z up, 0 on the
/// floor; see floor_frame), by observe_space.
///
/// A cell is occupied if its column has at least two thinned points in the band (one alone may be
/// noise). Else it is free if floor was seen there, or free space in at least a quarter of the
/// band, unless the lowest third of the band was in view but hidden. Else it is unknown. The grid
/// covers the known cells; without any it has size 0. Throws ResolutionError as observe_space does,
/// and beyond 2^25 cells.
[[nodiscard]] OccupancyGrid make_occupancy_grid(std::span<const Eigen::Vector3f> p_grid,
                                                std::span<const Eigen::Isometry3d> T_grid_camera,
                                                const CameraModel& camera,
                                                const SpaceOptions& options,
                                                const HeightBand& band);

/// The grid as an image for map_server of ROS: binary PGM, top row = highest y, 0 occupied, 254
/// free, 205 unknown.
[[nodiscard]] std::string encode_pgm(const OccupancyGrid& grid);

/// The YAML for that image. `T_grid_map`, which map_server ignores, is the 3 x 4 matrix, row by
/// row, that takes points of the map to the coordinate frame of the grid.
[[nodiscard]] std::string format_grid_yaml(const OccupancyGrid& grid,
                                           const std::string& image_name,
                                           const Eigen::Isometry3d& T_grid_map);

}  // namespace stillmap
