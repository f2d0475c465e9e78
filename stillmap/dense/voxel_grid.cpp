// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/voxel_grid.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/key_order.hpp"
#include "stillmap/dense/mean_color.hpp"

namespace stillmap {
namespace {

constexpr std::uint32_t kMaxWeight = std::numeric_limits<std::uint16_t>::max();

/// The least corner of the voxel, in voxels.
Eigen::Vector3d corner(std::uint64_t key) {
  constexpr std::uint64_t kAxisMask = (std::uint64_t{1} << VoxelIndex::kAxisBits) - 1;
  const auto axis = [key](unsigned shift) {
    return static_cast<double>(static_cast<std::int64_t>(key >> shift & kAxisMask) -
                               VoxelIndex::kReach);
  };
  return {axis(2 * VoxelIndex::kAxisBits), axis(VoxelIndex::kAxisBits), axis(0)};
}

}  // namespace

VoxelGrid::VoxelGrid(double voxel_size_m) : voxel_size_m_(voxel_size_m) {
  STILLMAP_CHECK(std::isfinite(voxel_size_m) && voxel_size_m > 0);
}

void VoxelGrid::add(const Eigen::Vector3f& position,
                    const Rgb& color,
                    std::uint8_t label,
                    std::uint16_t weight) {
  const Eigen::Vector3d scaled = position.cast<double>() / voxel_size_m_;
  const std::optional<VoxelIndex> at = voxel_at(scaled);
  if (weight == 0 || !at) return;
  Voxel& voxel = find_or_create(*at);
  if (voxel.weight + weight > kMaxWeight) return;
  const Eigen::Vector3d low(
      static_cast<double>(at->x), static_cast<double>(at->y), static_cast<double>(at->z));
  voxel.offset_sum += static_cast<float>(weight) * (scaled - low).cast<float>();
  for (std::size_t c = 0; c < 3; ++c) voxel.color_sum[c] += std::uint32_t{weight} * color[c];
  voxel.labels.add(label, weight);
  voxel.weight = static_cast<std::uint16_t>(voxel.weight + weight);
  labelled_ = labelled_ || label != 0;
}

VoxelGrid::Voxel& VoxelGrid::find_or_create(const VoxelIndex& at) {
  const VoxelIndex block{at.x >> kBlockBits, at.y >> kBlockBits, at.z >> kBlockBits};
  const std::uint32_t number = block_numbers_.find_or_add(block.key());
  if (number == blocks_.size()) blocks_.emplace_back().fill(KeyTable::kNone);
  const auto within = [](std::int64_t axis) {
    return static_cast<std::size_t>(axis & ((1 << kBlockBits) - 1));
  };
  std::uint32_t& index =
      blocks_[number][(within(at.x) << kBlockBits | within(at.y)) << kBlockBits | within(at.z)];
  if (index != KeyTable::kNone) return nth(index);
  index = static_cast<std::uint32_t>(size_);
  return create(at.key());
}

VoxelGrid::Voxel& VoxelGrid::create(std::uint64_t key) {
  STILLMAP_CHECK(size_ < KeyTable::kNone);
  if (size_ % kPieceSize == 0) pieces_.push_back(std::make_unique<Voxel[]>(kPieceSize));
  Voxel& created = nth(size_++);
  created.key = key;
  return created;
}

std::vector<std::uint32_t> VoxelGrid::order_by_key() const {
  std::vector<IndexedKey> keys(size_);
  for (std::size_t i = 0; i < size_; ++i) {
    keys[i] = {nth(i).key, static_cast<std::uint32_t>(i)};
  }
  keys = sorted_by_key(std::move(keys));
  std::vector<std::uint32_t> order(size_);
  for (std::size_t i = 0; i < size_; ++i) order[i] = keys[i].index;
  return order;
}

PointCloud VoxelGrid::extract() const {
  const std::vector<std::uint32_t> order = order_by_key();
  PointCloud cloud;
  cloud.positions.reserve(size_);
  cloud.colors.reserve(size_);
  if (labelled_) cloud.labels.reserve(size_);
  for (const std::uint32_t i : order) {
    const Voxel& voxel = nth(i);
    const Eigen::Vector3d offset = voxel.offset_sum.cast<double>() / voxel.weight;
    cloud.positions.emplace_back(((corner(voxel.key) + offset) * voxel_size_m_).cast<float>());
    cloud.colors.push_back(mean_color(voxel.color_sum, voxel.weight));
    if (labelled_) cloud.labels.push_back(voxel.labels.winner());
  }
  return cloud;
}

std::vector<Eigen::Vector3f> thinned(std::span<const Eigen::Vector3f> points, double voxel_size_m) {
  VoxelGrid grid(voxel_size_m);
  for (const Eigen::Vector3f& p : points) grid.add(p, Rgb{});
  return grid.extract().positions;
}

}  // namespace stillmap
