// SPDX-License-Identifier: Apache-2.0
#include "stillmap/formats/occupancy_grid.hpp"

#include <algorithm>
#include <cmath>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr int kMinPoints = 2;
constexpr double kMinSeenShare = 0.25;
constexpr double kMaxCells = 67108864;  // 2^26

// What a column of voxels says.
struct Column {
  int points = 0;       // in the band
  int seen_voxels = 0;  // in the band
  bool floor = false;
};

struct Extent {
  Eigen::Array2i low;
  Eigen::Array2i size;
};

Extent extent_of(const ObservedSpace& space) {
  Eigen::Array2i low = space.voxels.front().index.head<2>();
  Eigen::Array2i high = low;
  for (const SpaceVoxel& voxel : space.voxels) {
    low = low.min(voxel.index.head<2>().array());
    high = high.max(voxel.index.head<2>().array());
  }
  const Eigen::Array2i size = high - low + 1;
  if (static_cast<double>(size.x()) * static_cast<double>(size.y()) > kMaxCells) {
    throw Error("the map is too wide for a grid of {} m; choose a larger --resolution",
                space.resolution_m);
  }
  return {low, size};
}

// Voxels are counted from the lower end of the band, so that none lies on both sides of it.
void add(Column& column, const SpaceVoxel& voxel, const HeightBand& band, double resolution_m) {
  const double bottom_m = band.min_m + voxel.index.z() * resolution_m;
  if (voxel.index.z() < 0) {
    const bool near_floor = bottom_m + resolution_m > -band.min_m;
    column.floor = column.floor || (voxel.occupied() && near_floor);
  } else if (bottom_m + resolution_m / 2 <= band.max_m) {
    column.points += voxel.points;
    column.seen_voxels += voxel.occupied() ? 0 : 1;
  }
}

// Names may hold anything; YAML's double quotes take all but these.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      result += fmt::format("\\x{:02x}", static_cast<int>(c));
    } else {
      result += c;
    }
  }
  return result + '"';
}

OccupancyGrid project_to_floor(const ObservedSpace& space, const HeightBand& band) {
  OccupancyGrid grid{.resolution_m = space.resolution_m, .cells = {}};
  if (space.voxels.empty()) return grid;
  const Extent extent = extent_of(space);
  grid.width = extent.size.x();
  grid.height = extent.size.y();
  grid.origin_m = extent.low.cast<double>() * space.resolution_m;
  std::vector<Column> columns(static_cast<std::size_t>(grid.width) *
                              static_cast<std::size_t>(grid.height));
  for (const SpaceVoxel& voxel : space.voxels) {
    const Eigen::Array2i at = voxel.index.head<2>().array() - extent.low;
    const std::size_t row = static_cast<std::size_t>(at.y()) * static_cast<std::size_t>(grid.width);
    add(columns[row + static_cast<std::size_t>(at.x())], voxel, band, space.resolution_m);
  }
  const double min_seen = kMinSeenShare * (band.max_m - band.min_m) / space.resolution_m;
  grid.cells.reserve(columns.size());
  for (const Column& column : columns) {
    const bool free = column.floor || (column.seen_voxels > 0 && column.seen_voxels >= min_seen);
    grid.cells.push_back(column.points >= kMinPoints ? GridCell::kOccupied
                         : free                      ? GridCell::kFree
                                                     : GridCell::kUnknown);
  }
  return grid;
}

}  // namespace

OccupancyGrid make_occupancy_grid(std::span<const Eigen::Vector3f> p_grid,
                                  std::span<const Eigen::Isometry3d> T_grid_camera,
                                  const CameraModel& camera,
                                  const SpaceOptions& options,
                                  const HeightBand& band) {
  const Eigen::Vector3d down(0, 0, -band.min_m);
  std::vector<Eigen::Vector3f> points;
  points.reserve(p_grid.size());
  for (const Eigen::Vector3f& p : p_grid) points.emplace_back(p + down.cast<float>());
  std::vector<Eigen::Isometry3d> cameras;
  for (const Eigen::Isometry3d& T : T_grid_camera)
    cameras.push_back(Eigen::Translation3d(down) * T);
  return project_to_floor(observe_space(points, cameras, camera, options), band);
}

std::string encode_pgm(const OccupancyGrid& grid) {
  std::string bytes = fmt::format("P5\n{} {}\n255\n", grid.width, grid.height);
  bytes.reserve(bytes.size() + grid.cells.size());
  for (int y = grid.height - 1; y >= 0; --y) {
    for (int x = 0; x < grid.width; ++x) {
      const GridCell cell = grid.at(x, y);
      const int gray = cell == GridCell::kOccupied ? 0 : cell == GridCell::kFree ? 254 : 205;
      bytes += static_cast<char>(gray);
    }
  }
  return bytes;
}

std::string format_grid_yaml(const OccupancyGrid& grid,
                             const std::string& image_name,
                             const Eigen::Isometry3d& T_grid_map) {
  // free_thresh 0.196: gray 205 is an occupancy of 50 / 255 = 0.19608, which must not be free.
  std::string text = fmt::format(
      "image: {}\n"
      "mode: trinary\n"
      "resolution: {}\n"
      "origin: [{}, {}, 0.0]\n"
      "negate: 0\n"
      "occupied_thresh: 0.65\n"
      "free_thresh: 0.196\n"
      "# The grid's frame: z up, 0 on the floor; origin below the first camera, x where it looks.\n"
      "# p_grid = T_grid_map (p_map, 1), with p_map a point of the run's map.ply:\n"
      "T_grid_map:\n",
      quoted(image_name),
      grid.resolution_m,
      grid.origin_m.x(),
      grid.origin_m.y());
  const Eigen::Matrix4d& T = T_grid_map.matrix();
  for (int row = 0; row < 3; ++row) {
    text += fmt::format(
        "  - [{:.9f}, {:.9f}, {:.9f}, {:.9f}]\n", T(row, 0), T(row, 1), T(row, 2), T(row, 3));
  }
  return text;
}

}  // namespace stillmap
