// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/surface_voxels.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr std::int32_t kHalfRange = 1 << 20;
constexpr unsigned kAxisBits = 21;

using Cell = Eigen::Vector3i;

// std::floor is a function call on baseline x86-64; this is not.
std::int32_t floor_to_int(float value) {
  const std::int32_t truncated = static_cast<std::int32_t>(value);
  return truncated - (static_cast<float>(truncated) > value ? 1 : 0);
}

Cell cell_of(const Eigen::Vector3f& scaled) {
  return {floor_to_int(scaled.x()), floor_to_int(scaled.y()), floor_to_int(scaled.z())};
}

// Keys sort by x, then y, then z.
std::uint64_t key_of(const Cell& cell) {
  const auto part = [](std::int32_t i) { return static_cast<std::uint64_t>(i + kHalfRange); };
  return (part(cell.x()) << (2 * kAxisBits)) | (part(cell.y()) << kAxisBits) | part(cell.z());
}

// Points sorted by the cubes they lie in.
class CellIndex {
 public:
  CellIndex(const PointCloud& cloud, float cell_size) : cell_size_(cell_size) {
    entries_.reserve(cloud.size());
    for (const Eigen::Vector3f& position : cloud.positions) {
      entries_.push_back({key_of(cell(position)), position});
    }
    std::ranges::stable_sort(entries_, {}, &Entry::key);
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      Range& range = ranges_.try_emplace(entries_[i].key, Range{i, i}).first->second;
      range.end = i + 1;
    }
  }

  [[nodiscard]] Cell cell(const Eigen::Vector3f& position) const {
    return cell_of(position / cell_size_);
  }

  // All points within a cell's size of a point in `center`, and some others.
  [[nodiscard]] std::vector<Eigen::Vector3f> around(const Cell& center) const {
    std::vector<Eigen::Vector3f> near;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          const auto found = ranges_.find(key_of(center + Cell(dx, dy, dz)));
          if (found == ranges_.end()) continue;
          for (std::size_t i = found->second.begin; i < found->second.end; ++i) {
            near.push_back(entries_[i].position);
          }
        }
      }
    }
    return near;
  }

 private:
  struct Entry {
    std::uint64_t key;
    Eigen::Vector3f position;
  };
  struct Range {
    std::size_t begin, end;
  };

  float cell_size_;
  std::vector<Entry> entries_;
  std::unordered_map<std::uint64_t, Range> ranges_;
};

}  // namespace

SurfaceVoxels::SurfaceVoxels(double voxel_size_m)
    : voxels_a_metre_(static_cast<float>(1.0 / voxel_size_m)) {
  STILLMAP_CHECK(std::isfinite(voxel_size_m) && voxel_size_m > 0);
}

SurfaceVoxels::Block& SurfaceVoxels::block_at(std::uint64_t key) {
  if (last_block_ != nullptr && key == last_key_) return *last_block_;
  Block*& block = block_of_[key];
  if (block == nullptr) block = &blocks_.emplace_back();
  last_key_ = key;
  last_block_ = block;
  return *block;
}

void SurfaceVoxels::add(const Eigen::Vector3f& position, const Rgb& color) {
  const Eigen::Vector3f scaled = position * voxels_a_metre_;
  STILLMAP_CHECK((scaled.array().abs() < static_cast<float>(kHalfRange)).all());
  const Cell cell = cell_of(scaled);
  const Eigen::Vector3f center = cell.cast<float>() + Eigen::Vector3f::Constant(0.5F);
  const float distance = (scaled - center).squaredNorm();
  const Cell block_cell(cell.x() >> 3, cell.y() >> 3, cell.z() >> 3);
  const int inside = ((cell.x() & 7) << 6) | ((cell.y() & 7) << 3) | (cell.z() & 7);
  std::uint32_t& slot = block_at(key_of(block_cell))[static_cast<std::size_t>(inside)];
  if (slot == 0) {
    points_.push_back({key_of(cell), position, distance, color});
    slot = static_cast<std::uint32_t>(points_.size());
    return;
  }
  Point& point = points_[slot - 1];
  if (distance < point.distance) point = {point.key, position, distance, color};
}

PointCloud SurfaceVoxels::extract() const {
  std::vector<const Point*> order;
  order.reserve(points_.size());
  for (const Point& point : points_) order.push_back(&point);
  std::ranges::sort(order, {}, &Point::key);
  PointCloud cloud;
  cloud.positions.reserve(order.size());
  cloud.colors.reserve(order.size());
  for (const Point* point : order) {
    cloud.positions.push_back(point->position);
    cloud.colors.push_back(point->color);
  }
  return cloud;
}

PointCloud points_clear_of(const PointCloud& cloud, const PointCloud& others, double clearance_m) {
  STILLMAP_CHECK(clearance_m > 0 && cloud.colors.size() == cloud.size());
  // Somewhat larger cells, so that rounding hides no neighbour.
  const CellIndex index(others, static_cast<float>(1.001 * clearance_m));
  // Neighbours in the cloud mostly share a cell, so that its surroundings are gathered once.
  std::unordered_map<std::uint64_t, std::vector<Eigen::Vector3f>> surroundings;
  const double limit = clearance_m * clearance_m;
  PointCloud clear;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& position = cloud.positions[i];
    const Cell cell = index.cell(position);
    const auto [entry, is_new] = surroundings.try_emplace(key_of(cell));
    if (is_new) entry->second = index.around(cell);
    const bool near = std::ranges::any_of(entry->second, [&](const Eigen::Vector3f& other) {
      return (other.cast<double>() - position.cast<double>()).squaredNorm() <= limit;
    });
    if (near) continue;
    clear.positions.push_back(position);
    clear.colors.push_back(cloud.colors[i]);
  }
  return clear;
}

}  // namespace stillmap
