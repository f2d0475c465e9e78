// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/occupancy_grid.hpp"

#include <algorithm>
#include <cmath>

#include "stillmap/core/error.hpp"
#include "tooling/export/view_cone.hpp"

namespace stillmap {
namespace {

constexpr int kMinPoints = 2;
constexpr double kMinSeenShare = 0.25;
constexpr double kMaxCells = 33554432;  // 2^25

// Counts in a column of voxels.
struct Column {
  int points = 0;       // in the band
  int seen_voxels = 0;  // in the band
  int seen_low = 0;     // seen voxels in the lowest third of the band
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
    throw ResolutionError("the map is too wide for cells of {} m; choose larger ones",
                          space.resolution_m);
  }
  return {low, size};
}

double lowest_third_m(const HeightBand& band) {
  return band.min_m + (band.max_m - band.min_m) / 3;
}

// Voxels are counted from the lower end of the band, so that no voxel straddles it.
void add(Column& column, const SpaceVoxel& voxel, const HeightBand& band, double resolution_m) {
  const double bottom_m = band.min_m + voxel.index.z() * resolution_m;
  if (voxel.index.z() < 0) {
    const bool near_floor = bottom_m + resolution_m > -band.min_m;
    column.floor = column.floor || (voxel.occupied() && near_floor);
  } else if (bottom_m + resolution_m / 2 <= band.max_m) {
    column.points += voxel.points;
    if (voxel.occupied()) return;
    ++column.seen_voxels;
    if (bottom_m + resolution_m / 2 < lowest_third_m(band)) ++column.seen_low;
  }
}

// A name may have any character. These two have to be escaped within YAML's double quotes.
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

// Distinguishes ground that no camera faced from ground that an obstacle hid.
class GroundView {
 public:
  GroundView(std::span<const Eigen::Isometry3d> T_world_camera,
             const CameraModel& camera,
             double max_range_m)
      : cone_(camera), max_range_m_(max_range_m) {
    for (const Eigen::Isometry3d& T : T_world_camera) T_camera_world_.push_back(T.inverse());
  }

  [[nodiscard]] bool covers(const Eigen::Vector3d& p) const {
    return std::ranges::any_of(T_camera_world_, [&](const Eigen::Isometry3d& T) {
      const Eigen::Vector3d p_camera = T * p;
      return p_camera.norm() <= max_range_m_ && cone_.pixel(p_camera).has_value();
    });
  }

 private:
  ViewCone cone_;
  double max_range_m_;
  std::vector<Eigen::Isometry3d> T_camera_world_;
};

// The columns of observed space with z = 0 at the lower end of the band.
class Columns {
 public:
  Columns(const ObservedSpace& space, const HeightBand& band)
      : band_(band), resolution_m_(space.resolution_m), extent_(extent_of(space)) {
    columns_.resize(static_cast<std::size_t>(extent_.size.x()) *
                    static_cast<std::size_t>(extent_.size.y()));
    for (const SpaceVoxel& voxel : space.voxels) {
      const Eigen::Array2i cell = voxel.index.head<2>().array() - extent_.low;
      add(columns_[index(cell.x(), cell.y())], voxel, band, resolution_m_);
    }
  }

  [[nodiscard]] OccupancyGrid judge(const GroundView& view) const {
    OccupancyGrid grid{.width = extent_.size.x(),
                       .height = extent_.size.y(),
                       .resolution_m = resolution_m_,
                       .origin_m = extent_.low.cast<double>() * resolution_m_,
                       .cells = {}};
    grid.cells.reserve(columns_.size());
    for (int y = 0; y < grid.height; ++y) {
      for (int x = 0; x < grid.width; ++x) grid.cells.push_back(judge_cell(x, y, view));
    }
    return grid;
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(extent_.size.x()) +
           static_cast<std::size_t>(x);
  }

  [[nodiscard]] GridCell judge_cell(int x, int y, const GroundView& view) const {
    const Column& column = columns_[index(x, y)];
    if (column.points >= kMinPoints) return GridCell::kOccupied;
    if (column.floor) return GridCell::kFree;
    const double enough = kMinSeenShare * (band_.max_m - band_.min_m) / resolution_m_;
    if (column.seen_voxels == 0 || column.seen_voxels < enough) return GridCell::kUnknown;
    if (column.seen_low > 0) return GridCell::kFree;
    const Eigen::Vector2d middle =
        resolution_m_ * ((extent_.low + Eigen::Array2i(x, y)).cast<double>() + 0.5).matrix();
    const Eigen::Vector3d low(middle.x(), middle.y(), (lowest_third_m(band_) - band_.min_m) / 2);
    return view.covers(low) ? GridCell::kUnknown : GridCell::kFree;
  }

  HeightBand band_;
  double resolution_m_;
  Extent extent_;
  std::vector<Column> columns_;
};

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
  const ObservedSpace space = observe_space(points, cameras, camera, options);
  if (space.voxels.empty()) return OccupancyGrid{.resolution_m = options.resolution_m, .cells = {}};
  return Columns(space, band).judge(GroundView(cameras, camera, options.max_range_m));
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
