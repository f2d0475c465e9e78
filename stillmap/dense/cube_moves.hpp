// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "stillmap/dense/key_table.hpp"
#include "stillmap/dense/voxel_key.hpp"

namespace stillmap {

/// Displacements of surface in the world, one for each cube of space.
class CubeMoves {
 public:
  struct Move {
    Eigen::Vector3f place;  ///< in the cube, metres
    Eigen::Vector3f move;   ///< of the surface there, metres
    /// Of the plane through the place on which the points of the cube come to lie; zero: they only
    /// move.
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  };

  /// `edge_m` is that of the cubes.
  explicit CubeMoves(double edge_m) : edge_m_(edge_m) {}

  /// The first for a cube counts.
  void add(const Move& move) {
    const auto cube = voxel_at(move.place.cast<double>() / edge_m_);
    if (cube && cubes_.find_or_add(cube->key()) == moves_.size()) moves_.push_back(move);
  }

  /// The displacement of a point; zero where no cube has one.
  [[nodiscard]] Eigen::Vector3f at(const Eigen::Vector3f& point) const {
    const auto cube = voxel_at(point.cast<double>() / edge_m_);
    const std::uint32_t found = cube ? cubes_.find(cube->key()) : KeyTable::kNone;
    if (found == KeyTable::kNone) return Eigen::Vector3f::Zero();
    const Move& move = moves_[found];
    return move.move + move.normal * move.normal.dot(move.place - point);
  }

 private:
  double edge_m_;
  KeyTable cubes_;
  std::vector<Move> moves_;
};

}  // namespace stillmap
