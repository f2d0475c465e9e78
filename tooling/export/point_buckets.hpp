// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace stillmap {

/// The cube of edge `cell_m` with the point; nothing for a point that is not finite or more than
/// 2^20 cubes from the origin.
[[nodiscard]] inline std::optional<Eigen::Vector3i> cell_of(const Eigen::Vector3f& p,
                                                            double cell_m) {
  constexpr double kReach = (1 << 20) - 4;
  const Eigen::Vector3d scaled = p.cast<double>() / cell_m;
  if (!(scaled.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() < kReach)) return std::nullopt;
  return Eigen::Vector3i(scaled.array().floor().cast<int>());
}

/// Cells, numbered in the order in which they were inserted.
class CellSet {
 public:
  /// The number of the cell, and whether it is new.
  std::pair<std::size_t, bool> insert(const Eigen::Vector3i& cell) {
    const auto [entry, is_new] = numbers_.emplace(key_of(cell), cells_.size());
    if (is_new) cells_.push_back(cell);
    return {entry->second, is_new};
  }
  [[nodiscard]] std::optional<std::size_t> find(const Eigen::Vector3i& cell) const {
    const auto entry = numbers_.find(key_of(cell));
    return entry == numbers_.end() ? std::nullopt : std::optional(entry->second);
  }
  [[nodiscard]] std::size_t size() const { return cells_.size(); }

  /// These cells and all that touch one, each once.
  [[nodiscard]] std::vector<Eigen::Vector3i> with_neighbours() const {
    CellSet all;
    for (const Eigen::Vector3i& cell : cells_) {
      for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
          for (int z = -1; z <= 1; ++z) all.insert(cell + Eigen::Vector3i(x, y, z));
        }
      }
    }
    return std::move(all.cells_);
  }

 private:
  static std::uint64_t key_of(const Eigen::Vector3i& cell) {
    const auto axis = [](int v) { return static_cast<std::uint64_t>(v + (1 << 20)); };
    return axis(cell.x()) << 42U | axis(cell.y()) << 21U | axis(cell.z());
  }

  std::unordered_map<std::uint64_t, std::size_t> numbers_;  // never iterated: its order is none
  std::vector<Eigen::Vector3i> cells_;
};

/// Points by cubes, to find those near a place.
class PointBuckets {
 public:
  /// `points` must outlive this.
  PointBuckets(std::span<const Eigen::Vector3f> points, double cell_m) : cell_m_(cell_m) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::optional<Eigen::Vector3i> cell = cell_of(points[i], cell_m);
      if (!cell) continue;
      const auto [number, is_new] = cells_.insert(*cell);
      if (is_new) members_.emplace_back();
      members_[number].push_back(static_cast<std::uint32_t>(i));
    }
  }

  /// Calls visit(index) for all points within the cubes around the place: at least those within
  /// `cell_m`. In an order that depends only on the points.
  template <class Visit>
  void for_each_near(const Eigen::Vector3f& place, const Visit& visit) const {
    const std::optional<Eigen::Vector3i> middle = cell_of(place, cell_m_);
    if (!middle) return;
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const auto number = cells_.find(*middle + Eigen::Vector3i(x, y, z));
          if (!number) continue;
          for (const std::uint32_t i : members_[*number]) visit(i);
        }
      }
    }
  }

 private:
  double cell_m_;
  CellSet cells_;
  std::vector<std::vector<std::uint32_t>> members_;
};

}  // namespace stillmap
