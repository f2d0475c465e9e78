// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/voxel_grid.hpp"

#include <cmath>
#include <limits>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/key_order.hpp"
#include "stillmap/dense/mean_color.hpp"

namespace stillmap {
namespace {

constexpr std::uint32_t kEmptySlot = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kMaxWeight = std::numeric_limits<std::uint16_t>::max();
constexpr std::size_t kFirstTableSize = 4096;
constexpr unsigned kAxisBits = 21;
constexpr std::int64_t kAxisOffset = std::int64_t{1} << (kAxisBits - 1);
constexpr std::uint64_t kAxisMask = (std::uint64_t{1} << kAxisBits) - 1;

/// A floor for values of a few million at most; std::floor is a library call on plain x86-64.
std::int64_t floor_small(double value) {
  const auto truncated = static_cast<std::int64_t>(value);
  return truncated - static_cast<std::int64_t>(value < static_cast<double>(truncated));
}

std::uint64_t pack(std::int64_t x, std::int64_t y, std::int64_t z) {
  return static_cast<std::uint64_t>(x + kAxisOffset) << (2 * kAxisBits) |
         static_cast<std::uint64_t>(y + kAxisOffset) << kAxisBits |
         static_cast<std::uint64_t>(z + kAxisOffset);
}

/// The least corner of the voxel, in voxels.
Eigen::Vector3d corner(std::uint64_t key) {
  const auto axis = [key](unsigned shift) {
    return static_cast<double>(static_cast<std::int64_t>(key >> shift & kAxisMask) - kAxisOffset);
  };
  return {axis(2 * kAxisBits), axis(kAxisBits), axis(0)};
}

/// The finisher of splitmix64: every bit of the key changes about half of the bits.
std::uint64_t mix(std::uint64_t key) {
  key = (key ^ (key >> 30U)) * 0xbf58476d1ce4e5b9U;
  key = (key ^ (key >> 27U)) * 0x94d049bb133111ebU;
  return key ^ (key >> 31U);
}

}  // namespace

VoxelGrid::VoxelGrid(double voxel_size_m) : voxel_size_m_(voxel_size_m) {
  STILLMAP_CHECK(std::isfinite(voxel_size_m) && voxel_size_m > 0);
  table_.assign(kFirstTableSize, kEmptySlot);
}

void VoxelGrid::add(const Eigen::Vector3f& position,
                    const Rgb& color,
                    std::uint8_t label,
                    std::uint16_t weight) {
  const Eigen::Vector3d scaled = position.cast<double>() / voxel_size_m_;
  const auto in_range = [](double v) { return v >= -kAxisOffset && v < kAxisOffset; };
  if (weight == 0 || !(in_range(scaled.x()) && in_range(scaled.y()) && in_range(scaled.z()))) {
    return;
  }
  const std::int64_t x = floor_small(scaled.x());
  const std::int64_t y = floor_small(scaled.y());
  const std::int64_t z = floor_small(scaled.z());
  Voxel& voxel = find_or_create(pack(x, y, z));
  if (voxel.weight + weight > kMaxWeight) return;
  const Eigen::Vector3d low(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
  voxel.offset_sum += static_cast<float>(weight) * (scaled - low).cast<float>();
  for (std::size_t c = 0; c < 3; ++c) voxel.color_sum[c] += std::uint32_t{weight} * color[c];
  voxel.labels.add(label, weight);
  voxel.weight = static_cast<std::uint16_t>(voxel.weight + weight);
  labelled_ = labelled_ || label != 0;
}

VoxelGrid::Voxel& VoxelGrid::find_or_create(std::uint64_t key) {
  if (size_ > 0 && voxel_at(last_).key == key) return voxel_at(last_);
  const std::size_t slot = slot_of(key);
  if (table_[slot] == kEmptySlot) {
    table_[slot] = static_cast<std::uint32_t>(size_);
    return create(key);
  }
  last_ = table_[slot];
  return voxel_at(last_);
}

VoxelGrid::Voxel& VoxelGrid::create(std::uint64_t key) {
  STILLMAP_CHECK(size_ < kEmptySlot);
  if (size_ % kBlockSize == 0) blocks_.push_back(std::make_unique<Voxel[]>(kBlockSize));
  last_ = size_++;
  voxel_at(last_).key = key;
  if (2 * size_ > table_.size()) grow_table();
  return voxel_at(last_);
}

/// The slot of the key's voxel in the table, or the empty slot where it belongs.
std::size_t VoxelGrid::slot_of(std::uint64_t key) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = mix(key) & mask;
  while (table_[slot] != kEmptySlot && voxel_at(table_[slot]).key != key) slot = (slot + 1) & mask;
  return slot;
}

void VoxelGrid::grow_table() {
  const std::size_t mask = 2 * table_.size() - 1;
  table_.assign(mask + 1, kEmptySlot);
  for (std::size_t i = 0; i < size_; ++i) {
    std::size_t slot = mix(voxel_at(i).key) & mask;
    while (table_[slot] != kEmptySlot) slot = (slot + 1) & mask;
    table_[slot] = static_cast<std::uint32_t>(i);
  }
}

std::vector<std::uint32_t> VoxelGrid::order_by_key() const {
  std::vector<IndexedKey> keys(size_);
  for (std::size_t i = 0; i < size_; ++i) {
    keys[i] = {voxel_at(i).key, static_cast<std::uint32_t>(i)};
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
    const Voxel& voxel = voxel_at(i);
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
