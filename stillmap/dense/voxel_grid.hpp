// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/dense/key_table.hpp"
#include "stillmap/dense/label_vote.hpp"
#include "stillmap/dense/voxel_key.hpp"

namespace stillmap {

/// Thins points to one per voxel: the mean of positions and colours, the winning label (see
/// LabelVote). Voxel i along an axis covers [i, i + 1) * voxel_size_m.
///
/// Takes 48 bytes per voxel and about 270 for each block of 4 x 4 x 4 voxels that has any: some 65
/// per voxel of a surface, more where single points are scattered. extract() takes 32 more, its
/// result included.
class VoxelGrid {
 public:
  /// `voxel_size_m` is the edge of a voxel, finite and > 0.
  explicit VoxelGrid(double voxel_size_m);

  /// Counts the point `weight` times. Ignores a point that is not finite or more than 2^20 voxels
  /// from the origin along an axis, and a point whose weight would raise its voxel's sum over
  /// 65535.
  void add(const Eigen::Vector3f& position,
           const Rgb& color,
           std::uint8_t label = 0,
           std::uint16_t weight = 1);

  /// The number of voxels with points.
  [[nodiscard]] std::size_t size() const { return size_; }

  /// One point per voxel, ordered by the voxel's x, then y, then z; without labels if all are 0.
  /// The same points added in the same order give the same bits.
  [[nodiscard]] PointCloud extract() const;

 private:
  struct Voxel {
    std::uint64_t key = 0;
    /// from the corner of the voxel, in voxels
    Eigen::Vector3f offset_sum = Eigen::Vector3f::Zero();
    std::array<std::uint32_t, 3> color_sum{};
    LabelVote labels;
    std::uint16_t weight = 0;
  };
  /// Voxels that are near each other share a block, because consecutive points mostly are, too: the
  /// index of each voxel, or KeyTable::kNone.
  static constexpr unsigned kBlockBits = 2;
  using Block = std::array<std::uint32_t, 1U << (3 * kBlockBits)>;
  // Small pieces instead of one array: growth copies nothing and leaves little memory unused.
  static constexpr std::size_t kPieceSize = 1024;

  [[nodiscard]] Voxel& nth(std::size_t i) { return pieces_[i / kPieceSize][i % kPieceSize]; }
  [[nodiscard]] const Voxel& nth(std::size_t i) const {
    return pieces_[i / kPieceSize][i % kPieceSize];
  }
  [[nodiscard]] Voxel& find_or_create(const VoxelIndex& at);
  [[nodiscard]] Voxel& create(std::uint64_t key);
  [[nodiscard]] std::vector<std::uint32_t> order_by_key() const;

  double voxel_size_m_;
  std::vector<std::unique_ptr<Voxel[]>> pieces_;  ///< voxels in the order of their first points
  std::size_t size_ = 0;
  KeyTable block_numbers_;
  std::deque<Block> blocks_;
  bool labelled_ = false;
};

/// The mean position of the points of each voxel, in the order of VoxelGrid.
[[nodiscard]] std::vector<Eigen::Vector3f> thinned(std::span<const Eigen::Vector3f> points,
                                                   double voxel_size_m);

}  // namespace stillmap
