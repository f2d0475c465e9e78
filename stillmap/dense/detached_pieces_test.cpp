// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/detached_pieces.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

/// Points in the middles of cubes of 2 cm, with how often views see them and see motion there.
struct Cubes {
  std::vector<Eigen::Vector3f> means;
  std::vector<Sightings> seen;

  /// A patch of so many cubes along x and y whose first cube is at a place; returns its first
  /// index.
  std::size_t add(Eigen::Vector3i place, int width, int height, std::uint8_t moving) {
    for (int x = 0; x < width; ++x) {
      for (int y = 0; y < height; ++y) {
        const Eigen::Vector3i cube = place + Eigen::Vector3i(x, y, 0);
        means.emplace_back((cube.cast<float>().array() + 0.5F) * 0.02F);
        seen.push_back({.seen = 10, .moving = moving});
      }
    }
    return means.size() - static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }

  [[nodiscard]] std::vector<bool> kept(const FreeSpaceConfig& config = {}) const {
    return without_detached_pieces(means, seen, std::vector<bool>(means.size(), true), config);
  }
};

std::ptrdiff_t count(const std::vector<bool>& kept) {
  return std::ranges::count(kept, true);
}

constexpr std::uint8_t kMostly = 12, kSeldom = 8;  // of motion, for 10 views that see a point

TEST(DetachedPieces, AHandInTheAirGoes) {
  Cubes cubes;
  cubes.add({0, 0, 0}, 40, 40, 0);  // a wall
  const std::size_t hand = cubes.add({10, 10, 20}, 4, 6, kMostly);
  const std::vector<bool> kept = cubes.kept();
  EXPECT_EQ(count(kept), 40 * 40);
  EXPECT_FALSE(kept[hand]);
  EXPECT_EQ(count(cubes.kept({.detached_m = 0})), 40 * 40 + 24);
}

TEST(DetachedPieces, WhatIsMostlySeenAsStaticStaysInTheAir) {
  Cubes cubes;
  cubes.add({0, 0, 0}, 4, 6, kSeldom);
  EXPECT_EQ(count(cubes.kept()), 24);
}

TEST(DetachedPieces, WhatTouchesSomethingStays) {
  Cubes cubes;
  cubes.add({0, 0, 0}, 40, 40, 0);
  cubes.add({10, 10, 2}, 4, 6, kMostly);  // one empty cube before the wall
  EXPECT_EQ(count(cubes.kept()), 40 * 40 + 24);
}

TEST(DetachedPieces, ALargePieceStaysFromWhicheverCubeItIsReached) {
  Cubes cubes;
  cubes.add({0, 0, 0}, 12, 3, kMostly);  // 24 cm
  EXPECT_EQ(count(cubes.kept()), 36);
  EXPECT_EQ(count(cubes.kept({.detached_m = 0.25})), 0);
}

TEST(DetachedPieces, ALoneCubeGoesTwoStay) {
  Cubes cubes;
  const std::size_t lone = cubes.add({0, 0, 0}, 1, 1, 0);
  cubes.add({10, 0, 0}, 1, 1, 0);
  cubes.add({12, 2, 1}, 1, 1, 0);
  const std::vector<bool> kept = cubes.kept();
  EXPECT_FALSE(kept[lone]);
  EXPECT_EQ(count(kept), 2);
}

TEST(DetachedPieces, CubesThatHaveLeftTheMapHoldNothing) {
  Cubes cubes;
  cubes.add({0, 0, 0}, 1, 1, 0);
  cubes.add({1, 0, 0}, 1, 1, 0);
  EXPECT_EQ(count(without_detached_pieces(cubes.means, cubes.seen, {true, false}, {})), 0);
}

}  // namespace
}  // namespace stillmap
