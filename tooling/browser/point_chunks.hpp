// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "stillmap/core/point_cloud.hpp"

namespace stillmap {

/// The points of a cube of space, in the order in which they came.
struct PointChunk {
  std::array<int, 3> cell{};             ///< its corner is cell * PointChunks::kSide_m
  std::vector<std::uint16_t> positions;  ///< x, y, z from the corner, in steps of kStep_m
  std::vector<std::uint8_t> colors;      ///< red, green, blue

  [[nodiscard]] std::size_t size() const { return colors.size() / 3; }
};

/// Points by cubes of space, so that a page is sent only what it lacks of each, and draws fewer
/// points of what is far. Chunks keep their places in the list.
class PointChunks {
 public:
  static constexpr double kSide_m = 2;
  static constexpr double kStep_m = kSide_m / 65536;  ///< 31 micrometres

  /// Adds the finite points within 10 km of the origin, up to kMostPoints in all.
  void add(const PointCloud& cloud);

  [[nodiscard]] const std::vector<PointChunk>& chunks() const { return chunks_; }
  [[nodiscard]] std::size_t size() const { return points_; }

  static constexpr std::size_t kMostPoints = 20'000'000;

 private:
  std::size_t place_of(const std::array<int, 3>& cell);

  std::vector<PointChunk> chunks_;
  std::map<std::array<int, 3>, std::size_t> places_;  // in chunks_
  std::size_t points_ = 0;
};

}  // namespace stillmap
