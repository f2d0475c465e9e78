// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/depth_planes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

constexpr int kColumns = 80, kRows = 60;
constexpr double kFocal = 66;  // in cells
enum Surface : int { kNothing, kWall, kFloor, kBall };

/// A room as a depth camera sees it from 1.2 m above the floor: a wall at 3.5 m, the floor, and a
/// ball of a person's size before them.
class Room {
 public:
  Room() {
    std::mt19937 rng(3);
    std::normal_distribution<double> noise;
    for (int i = 0; i < kColumns * kRows; ++i) {
      const double x = (i % kColumns - kColumns / 2) / kFocal;
      const double y = (i / kColumns - kRows / 2) / kFocal;
      double z = 3.5;
      Surface surface = kWall;
      if (y * z > 1.2) {
        z = 1.2 / y;
        surface = kFloor;
      }
      // |z (x, y, 1) - (-0.8, 0, 2.2)| = 0.35
      const double a = x * x + y * y + 1, b = -0.8 * x + 2.2, c = 0.64 + 4.84 - 0.1225;
      if (b * b > a * c) {
        z = (b - std::sqrt(b * b - a * c)) / a;
        surface = kBall;
      }
      depth_m.push_back(static_cast<float>(z + 0.0015 * z * z * noise(rng)));
      surfaces.push_back(surface);
      ++cells_of[surface];
    }
  }
  std::vector<float> depth_m;
  std::vector<Surface> surfaces;
  std::map<Surface, std::size_t> cells_of;
};

TEST(PlanarParts, AreWallAndFloorAndNoBall) {
  const Room room;
  // The ball, of 400 cells, leaves pieces that are too small to be round within noise.
  const std::vector<PlanarPart> parts = planar_parts({room.depth_m, kColumns, kRows}, 100);
  ASSERT_EQ(parts.size(), 2U);
  std::map<Surface, std::size_t> found;
  for (const PlanarPart& part : parts) {
    std::map<Surface, std::size_t> shown;
    for (const int i : part) ++shown[room.surfaces[static_cast<std::size_t>(i)]];
    const auto most = std::ranges::max_element(
        shown, {}, [](const std::pair<const Surface, std::size_t>& entry) { return entry.second; });
    EXPECT_GT(static_cast<double>(most->second), 0.97 * static_cast<double>(part.size()));
    found[most->first] = most->second;
  }
  for (const Surface surface : {kWall, kFloor}) {
    EXPECT_GT(static_cast<double>(found[surface]),
              0.9 * static_cast<double>(room.cells_of.at(surface)));
  }
}

TEST(PlanarParts, HaveNoCellsWithoutDepth) {
  std::vector<float> depth(kColumns * kRows, 2.0F);
  std::fill(depth.begin() + 30 * kColumns, depth.begin() + 31 * kColumns, 0.0F);
  const std::vector<PlanarPart> parts = planar_parts({depth, kColumns, kRows}, 1);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].size(), 30U * kColumns);
  EXPECT_EQ(parts[1].size(), 29U * kColumns);
  const std::vector<float> dark(kColumns * kRows, 0.0F);
  EXPECT_TRUE(planar_parts({dark, kColumns, kRows}, 1).empty());
  EXPECT_TRUE(planar_parts({{}, 0, 0}, 1).empty());
}

}  // namespace
}  // namespace stillmap
