// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

/// Thins points of surfaces to one per voxel: the added point nearest to the voxel's centre,
/// unchanged; the first among equals. Voxel i along an axis covers [i, i + 1) * voxel_size_m.
class SurfaceVoxels {
 public:
  /// `voxel_size_m` is the edge of a voxel, finite and > 0.
  explicit SurfaceVoxels(double voxel_size_m);

  /// The point must be finite and less than 2^20 voxels from the origin along each axis.
  void add(const Eigen::Vector3f& position, const Rgb& color);

  /// The number of voxels with a point.
  [[nodiscard]] std::size_t size() const { return points_.size(); }

  /// The points, ordered by their voxels' x, then y, then z.
  [[nodiscard]] PointCloud extract() const;

 private:
  struct Point {
    std::uint64_t key;  // of the voxel
    Eigen::Vector3f position;
    float distance;  // squared, from the voxel's centre, in voxels
    Rgb color;
  };
  // Voxels of a surface are close together, so that blocks of them are looked up, mostly the last
  // one.
  static constexpr int kBlockSide = 8;
  using Block = std::array<std::uint32_t, kBlockSide * kBlockSide * kBlockSide>;  // 0 or 1 + index

  [[nodiscard]] Block& block_at(std::uint64_t key);

  float voxels_a_metre_;
  std::vector<Point> points_;
  std::deque<Block> blocks_;
  std::unordered_map<std::uint64_t, Block*> block_of_;
  std::uint64_t last_key_ = 0;
  Block* last_block_ = nullptr;
};

/// The points of `cloud` that are farther than `clearance_m` from every point of `others`, in
/// order.
[[nodiscard]] PointCloud points_clear_of(const PointCloud& cloud,
                                         const PointCloud& others,
                                         double clearance_m);

}  // namespace stillmap
