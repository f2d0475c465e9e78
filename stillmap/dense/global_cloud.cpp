// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/global_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "stillmap/concurrency/parallel.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/dense/voxel_grid.hpp"

namespace stillmap {
namespace {

/// A slice of space between two planes of voxel faces perpendicular to the x axis.
struct Slice {
  double begin, end;  // voxels

  [[nodiscard]] bool contains(double x) const { return x >= begin && x < end; }
};

/// The x coordinate in voxels, computed as in VoxelGrid, so that no voxel belongs to two slices.
double place(const Eigen::Vector3f& p_world, double voxel_size_m) {
  return static_cast<double>(p_world.x()) / voxel_size_m;
}

Eigen::Vector3f to_world(const PosedCloud& posed, std::size_t i) {
  return (posed.T_world_camera * posed.cloud->position(i).cast<double>()).cast<float>();
}

/// Slices with about equal numbers of points. A point with a NaN coordinate is in none.
std::vector<Slice> slices(std::span<const PosedCloud> clouds,
                          double voxel_size_m,
                          std::size_t count) {
  constexpr std::size_t kStep = 101;  // every 101st point is sampled
  constexpr double kEverywhere = std::numeric_limits<double>::infinity();
  std::vector<double> places;
  for (const PosedCloud& posed : clouds) {
    for (std::size_t i = 0; i < posed.cloud->size(); i += kStep) {
      const double x = place(to_world(posed, i), voxel_size_m);
      if (std::isfinite(x)) places.push_back(std::floor(x));
    }
  }
  std::ranges::sort(places);
  std::vector<Slice> all = {{-kEverywhere, kEverywhere}};
  for (std::size_t k = 1; k < count && !places.empty(); ++k) {
    const double face = places[k * places.size() / count];
    all.back().end = face;
    all.push_back({face, kEverywhere});
  }
  return all;
}

PointCloud cloud_in(const Slice& slice,
                    std::span<const PosedCloud> clouds,
                    double voxel_size_m,
                    std::span<const CubeMoves> moves) {
  VoxelGrid grid(voxel_size_m);
  for (const PosedCloud& posed : clouds) {
    const CompactCloud& cloud = *posed.cloud;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      Eigen::Vector3f p_world = to_world(posed, i);
      for (const CubeMoves& move : moves) p_world += move.at(p_world);
      if (!slice.contains(place(p_world, voxel_size_m))) continue;
      const std::uint8_t label = cloud.labels.empty() ? std::uint8_t{0} : cloud.labels[i];
      grid.add(p_world, cloud.colors[i], label);
    }
  }
  return grid.extract();
}

/// A grid whose labels are all 0 gives a cloud without labels.
void append(PointCloud& all, const PointCloud& part) {
  if (!part.labels.empty()) all.labels.resize(all.size(), 0);
  all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
  all.colors.insert(all.colors.end(), part.colors.begin(), part.colors.end());
  all.labels.insert(all.labels.end(), part.labels.begin(), part.labels.end());
  if (!all.labels.empty()) all.labels.resize(all.size(), 0);
}

}  // namespace

PointCloud global_cloud(std::span<const PosedCloud> clouds,
                        double voxel_size_m,
                        std::size_t threads,
                        std::span<const CubeMoves> moves) {
  STILLMAP_CHECK(threads > 0);
  for (const PosedCloud& posed : clouds) {
    STILLMAP_CHECK(posed.cloud != nullptr);
    const CompactCloud& cloud = *posed.cloud;
    STILLMAP_CHECK(cloud.colors.size() == cloud.size());
    STILLMAP_CHECK(cloud.labels.empty() || cloud.labels.size() == cloud.size());
  }
  // A voxel gets its points in the same order in every slicing, and grids give voxels in order of
  // x.
  const std::vector<Slice> all = slices(clouds, voxel_size_m, threads);
  std::vector<PointCloud> parts(all.size());
  in_parallel(all.size(),
              [&](std::size_t k) { parts[k] = cloud_in(all[k], clouds, voxel_size_m, moves); });
  PointCloud cloud = std::move(parts.front());
  for (std::size_t k = 1; k < parts.size(); ++k) append(cloud, parts[k]);
  return cloud;
}

}  // namespace stillmap
