// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/point_groups.hpp"

#include <cstddef>
#include <limits>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/key_order.hpp"

namespace stillmap {
namespace {

constexpr double kFarthestCells = 1 << 20;  // cells
constexpr std::uint64_t kNowhere = std::numeric_limits<std::uint64_t>::max();

/// Inserts two zero bits after each of the lowest 21 bits.
std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32U) & 0x001f00000000ffffU;
  x = (x | x << 16U) & 0x001f0000ff0000ffU;
  x = (x | x << 8U) & 0x100f00f00f00f00fU;
  x = (x | x << 4U) & 0x10c30c30c30c30c3U;
  return (x | x << 2U) & 0x1249249249249249U;
}

std::uint64_t morton_key(const Eigen::Vector3f& p, double cells_per_m) {
  const Eigen::Vector3d scaled = p.cast<double>() * cells_per_m;
  if (!(scaled.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() < kFarthestCells)) return kNowhere;
  const auto axis = [](double v) {
    return spread_bits(static_cast<std::uint64_t>(v + kFarthestCells));
  };
  return axis(scaled.x()) | axis(scaled.y()) << 1U | axis(scaled.z()) << 2U;
}

}  // namespace

PointGroups group_points(std::span<const Eigen::Vector3f> points, double cell_m) {
  STILLMAP_CHECK(cell_m > 0);
  std::vector<IndexedKey> keys(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    keys[i] = {morton_key(points[i], 1.0 / cell_m), static_cast<std::uint32_t>(i)};
  }
  keys = sorted_by_key(std::move(keys));
  PointGroups groups;
  groups.group_of.resize(points.size());
  for (std::size_t i = 0; i < keys.size();) {
    const std::uint64_t key = keys[i].key;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const std::size_t first = i;
    for (; i < keys.size() && keys[i].key == key; ++i) {
      sum += points[keys[i].index].cast<double>();
      groups.group_of[keys[i].index] = static_cast<std::uint32_t>(groups.means.size());
    }
    groups.means.emplace_back((sum / static_cast<double>(i - first)).cast<float>());
  }
  return groups;
}

}  // namespace stillmap
