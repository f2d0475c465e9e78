// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/map_quality.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/voxel_grid.hpp"
#include "tooling/eval/nearest_points.hpp"

namespace stillmap {
namespace {

using Points = std::vector<Eigen::Vector3f>;
using Cell = std::array<std::int32_t, 3>;

std::vector<double> distances(const Points& from, const NearestPoints& to) {
  std::vector<double> result;
  result.reserve(from.size());
  for (const Eigen::Vector3f& p : from) result.push_back(to.distance(p));
  return result;
}

double share(std::size_t part, std::size_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

double share_farther(std::span<const double> distances_m, double limit_m) {
  const auto farther = [limit_m](double distance) { return distance > limit_m; };
  return share(static_cast<std::size_t>(std::ranges::count_if(distances_m, farther)),
               distances_m.size());
}

double mean(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

Cell cell_of(const Eigen::Vector3f& p) {
  const auto index = [](float v) {
    return static_cast<std::int32_t>(std::floor(static_cast<double>(v) / kMapVoxel_m));
  };
  return {index(p.x()), index(p.y()), index(p.z())};
}

// The sizes of the groups of cells that touch by face, edge or corner. The cells must be sorted and
// unique.
std::vector<std::size_t> group_sizes(const std::vector<Cell>& cells) {
  std::vector<bool> seen(cells.size(), false);
  std::vector<std::size_t> sizes, open;
  const auto visit = [&](const Cell& cell) {
    const auto at = std::ranges::lower_bound(cells, cell);
    const std::size_t i = static_cast<std::size_t>(at - cells.begin());
    if (at == cells.end() || *at != cell || seen[i]) return;
    seen[i] = true;
    open.push_back(i);
  };
  for (const Cell& first : cells) {
    visit(first);
    std::size_t size = 0;
    for (; !open.empty(); ++size) {
      const Cell at = cells[open.back()];
      open.pop_back();
      for (int k = 0; k < 27; ++k) {
        visit({at[0] + k / 9 - 1, at[1] + k / 3 % 3 - 1, at[2] + k % 3 - 1});
      }
    }
    if (size > 0) sizes.push_back(size);
  }
  return sizes;
}

bool is_near(const Eigen::Vector3f& p, const NearestPoints& others) {
  return others.distance(p, 2 * kMapNear_m) <= kMapNear_m;
}

GhostFigures ghosts(const Points& map, std::span<const double> to_static_m, const Points& dynamic) {
  const NearestPoints nearest(dynamic);
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (to_static_m[i] > kMapNear_m && is_near(map[i], nearest)) {
      cells.push_back(cell_of(map[i]));
    }
  }
  GhostFigures figures;
  if (!map.empty()) figures.ratio = share(cells.size(), map.size());
  constexpr double kLitres = 1000 * kMapVoxel_m * kMapVoxel_m * kMapVoxel_m;
  figures.volume_l = kLitres * static_cast<double>(cells.size());
  std::ranges::sort(cells);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  figures.clusters = static_cast<std::size_t>(std::ranges::count_if(
      group_sizes(cells), [](std::size_t size) { return size >= kGhostClusterVoxels; }));
  return figures;
}

}  // namespace

void check_extent(const PointCloud& cloud, const std::string& name) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = cloud.positions[i];
    if ((p.array().abs() <= static_cast<float>(kMapExtent_m)).all()) continue;
    throw Error("{}: point {} is at {:g} {:g} {:g}, expected metres within {:g} of the origin",
                name,
                i,
                p.x(),
                p.y(),
                p.z(),
                kMapExtent_m);
  }
}

MapQuality map_quality(const PointCloud& map, const MapTruth& truth) {
  STILLMAP_CHECK(!truth.static_surface.empty());
  Points points = thinned(map.positions, kMapVoxel_m);
  const Points surface = thinned(truth.static_surface.positions, kMapVoxel_m);
  const NearestPoints nearest_static(surface);
  std::optional<NearestPoints> resting;
  if (truth.resting && !truth.resting->empty()) {
    resting.emplace(thinned(truth.resting->positions, kMapVoxel_m));
  }
  if (resting) {
    std::erase_if(points, [&](const Eigen::Vector3f& p) {
      return is_near(p, *resting) && !is_near(p, nearest_static);
    });
  }
  const NearestPoints nearest_map(points);
  const std::vector<double> to_map_m = distances(surface, nearest_map);
  const std::vector<double> to_static_m = distances(points, nearest_static);

  MapQuality quality;
  quality.voxels = points.size();
  quality.sa = 1.0 - share_farther(to_map_m, kMapNear_m);
  if (!points.empty()) {
    quality.accuracy_m = mean(to_static_m);
    quality.completeness_m = mean(to_map_m);
    quality.off_ratio_5cm = share_farther(to_static_m, 0.05);
    quality.off_ratio_10cm = share_farther(to_static_m, 0.10);
  }
  if (!truth.dynamic) return quality;
  Points dynamic = thinned(truth.dynamic->positions, kMapVoxel_m);
  if (resting) {
    std::erase_if(dynamic, [&](const Eigen::Vector3f& p) { return is_near(p, *resting); });
  }
  quality.ghosts = ghosts(points, to_static_m, dynamic);
  if (dynamic.empty()) return quality;
  quality.da = share_farther(distances(dynamic, nearest_map), kMapNear_m);
  const double sum = quality.sa + *quality.da;
  quality.aa = std::sqrt(quality.sa * *quality.da);
  quality.ha = sum > 0 ? 2 * quality.sa * *quality.da / sum : 0.0;
  return quality;
}

}  // namespace stillmap
