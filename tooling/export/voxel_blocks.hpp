// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include <Eigen/Core>

namespace stillmap {

/// A value per voxel of space, in blocks of 16 x 16 x 16 that are allocated on first use.
template <class T>
class VoxelBlocks {
 public:
  static constexpr int kEdge = 16;

  /// The value of the voxel, T{} at first. References stay valid.
  [[nodiscard]] T& at(const Eigen::Vector3i& voxel) {
    const Key key = {voxel.x() >> 4, voxel.y() >> 4, voxel.z() >> 4};
    if (last_ == nullptr || key != last_key_) {
      std::vector<T>& block = blocks_[key];
      if (block.empty()) block.resize(kVoxels);
      last_key_ = key;
      last_ = &block;
    }
    return (*last_)[static_cast<std::size_t>(((voxel.z() & 15) << 8) | ((voxel.y() & 15) << 4) |
                                             (voxel.x() & 15))];
  }

  [[nodiscard]] std::size_t block_count() const { return blocks_.size(); }

  /// Calls visit(index, value) for all voxels of all blocks, in an order that depends only on the
  /// set of blocks.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const auto& [key, block] : blocks_) {
      const Eigen::Vector3i corner = kEdge * Eigen::Vector3i(key[0], key[1], key[2]);
      for (int i = 0; i < kVoxels; ++i) {
        visit(Eigen::Vector3i(corner + Eigen::Vector3i(i & 15, (i >> 4) & 15, i >> 8)),
              block[static_cast<std::size_t>(i)]);
      }
    }
  }

 private:
  using Key = std::array<int, 3>;
  static constexpr int kVoxels = kEdge * kEdge * kEdge;

  std::map<Key, std::vector<T>> blocks_;
  Key last_key_{};
  // block of last_key_; neighbours are mostly used one after the other
  std::vector<T>* last_ = nullptr;
};

}  // namespace stillmap
