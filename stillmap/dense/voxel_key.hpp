// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

namespace stillmap {

/// A voxel of a grid: voxel i along an axis covers [i, i + 1) times the edge. At most 2^20 voxels
/// from the origin.
struct VoxelIndex {
  static constexpr unsigned kAxisBits = 21;
  static constexpr std::int64_t kReach = std::int64_t{1} << (kAxisBits - 1);

  std::int64_t x, y, z;

  /// Ordered by x, then y, then z.
  [[nodiscard]] std::uint64_t key() const {
    return static_cast<std::uint64_t>(x + kReach) << (2 * kAxisBits) |
           static_cast<std::uint64_t>(y + kReach) << kAxisBits |
           static_cast<std::uint64_t>(z + kReach);
  }
};

/// A floor for values of a few million at most; std::floor is a library call on plain x86-64.
[[nodiscard]] inline std::int64_t floor_small(double value) {
  const auto truncated = static_cast<std::int64_t>(value);
  return truncated - static_cast<std::int64_t>(value < static_cast<double>(truncated));
}

/// The voxel at a place in units of its edge; none where that is not finite or too far.
[[nodiscard]] inline std::optional<VoxelIndex> voxel_at(const Eigen::Vector3d& scaled) {
  constexpr auto kReach = static_cast<double>(VoxelIndex::kReach);
  const auto in_range = [](double v) { return v >= -kReach && v < kReach; };
  if (!(in_range(scaled.x()) && in_range(scaled.y()) && in_range(scaled.z()))) return std::nullopt;
  return VoxelIndex{floor_small(scaled.x()), floor_small(scaled.y()), floor_small(scaled.z())};
}

}  // namespace stillmap
