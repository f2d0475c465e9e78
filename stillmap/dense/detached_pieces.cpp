// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/detached_pieces.hpp"

#include <cstddef>
#include <cstdint>

#include <Eigen/Geometry>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/key_table.hpp"
#include "stillmap/dense/voxel_key.hpp"

namespace stillmap {
namespace {

constexpr int kLink = 2;  // cubes; thin and distant surface has gaps

/// The cubes of the map, by their place.
class Pieces {
 public:
  Pieces(std::span<const Eigen::Vector3f> means, const std::vector<bool>& kept, double cell_m)
      : means_(means), cell_m_(cell_m), state_(means.size(), State::kNew) {
    for (std::size_t i = 0; i < means.size(); ++i) {
      const auto at = voxel_at(means[i].cast<double>() / cell_m);
      if (!kept[i] || !at) continue;
      const std::uint32_t number = table_.find_or_add(at->key());
      if (number == cubes_.size()) cubes_.push_back(i);  // rounding may put two means in one cube
    }
  }

  /// Whether a cube is a piece by itself.
  [[nodiscard]] bool is_lone(std::size_t cube) const {
    int near = 0;
    for_each_beside(cube, [&near](std::size_t) { return ++near < 2; });  // itself is one
    return near < 2;
  }

  /// The piece of a cube; empty if it was asked for before, or is larger than `most_m`.
  [[nodiscard]] std::vector<std::size_t> of(std::size_t first, double most_m) {
    if (state_[first] != State::kNew) return {};
    std::vector<std::size_t> piece{first};
    state_[first] = State::kSmall;
    Eigen::AlignedBox3f extent;
    for (std::size_t next = 0; next < piece.size(); ++next) {
      extent.extend(means_[piece[next]]);
      const bool large = extent.sizes().maxCoeff() > static_cast<float>(most_m);
      if (!large && !touches_large(piece[next], piece)) continue;
      for (const std::size_t i : piece) state_[i] = State::kLarge;
      return {};
    }
    return piece;
  }

 private:
  enum class State : std::uint8_t { kNew, kSmall, kLarge };

  /// Adds the cubes beside one to its piece. Stops with true at a cube of a large piece.
  [[nodiscard]] bool touches_large(std::size_t cube, std::vector<std::size_t>& piece) {
    bool large = false;
    for_each_beside(cube, [&](std::size_t i) {
      large = state_[i] == State::kLarge;
      if (large) return false;
      if (state_[i] == State::kNew) piece.push_back(i);
      state_[i] = State::kSmall;
      return true;
    });
    return large;
  }

  /// Calls `visit` with a cube and the cubes around it, until it gives false.
  template <class Visit>
  void for_each_beside(std::size_t cube, const Visit& visit) const {
    const auto at = voxel_at(means_[cube].cast<double>() / cell_m_);
    if (!at) return;
    constexpr int kSide = 2 * kLink + 1;
    for (int k = 0; k < kSide * kSide * kSide; ++k) {
      const VoxelIndex beside{at->x + k / (kSide * kSide) - kLink,
                              at->y + k / kSide % kSide - kLink,
                              at->z + k % kSide - kLink};
      const std::uint32_t number = table_.find(beside.key());
      if (number != KeyTable::kNone && !visit(cubes_[number])) return;
    }
  }

  std::span<const Eigen::Vector3f> means_;
  double cell_m_;
  std::vector<State> state_;  // of each cube
  KeyTable table_;
  std::vector<std::size_t> cubes_;  // by number in the table
};

}  // namespace

std::vector<bool> without_detached_pieces(std::span<const Eigen::Vector3f> means,
                                          std::span<const Sightings> seen,
                                          std::vector<bool> kept,
                                          const FreeSpaceConfig& config) {
  STILLMAP_CHECK(seen.size() == means.size() && kept.size() == means.size());
  if (config.detached_m <= 0) return kept;
  Pieces pieces(means, kept, config.cell_m);
  for (std::size_t first = 0; first < means.size(); ++first) {
    if (!kept[first]) continue;
    if (pieces.is_lone(first)) {
      kept[first] = false;
      continue;
    }
    if (seen[first].moving == 0) continue;
    const std::vector<std::size_t> piece = pieces.of(first, config.detached_m);
    double moving = 0, still = 0;
    for (const std::size_t i : piece) {
      moving += seen[i].moving;
      still += seen[i].seen;
    }
    if (moving <= config.max_detached_share * still) continue;
    for (const std::size_t i : piece) kept[i] = false;
  }
  return kept;
}

}  // namespace stillmap
