// SPDX-License-Identifier: Apache-2.0
#include "tooling/browser/point_chunks.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

// Points in a box of some metres around the origin.
PointCloud random_cloud(std::size_t count) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> coordinate(-5.0F, 5.0F);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.positions.emplace_back(coordinate(rng), coordinate(rng), coordinate(rng));
    cloud.colors.push_back({static_cast<std::uint8_t>(i & 0xffU),
                            static_cast<std::uint8_t>(i >> 8U),
                            static_cast<std::uint8_t>(3)});
  }
  return cloud;
}

TEST(PointChunks, KeepsEveryPointToAFractionOfAMillimetre) {
  const PointCloud cloud = random_cloud(2000);
  PointChunks chunks;
  chunks.add(cloud);
  EXPECT_EQ(chunks.size(), cloud.size());
  std::size_t found = 0;
  for (const PointChunk& chunk : chunks.chunks()) {
    for (std::size_t i = 0; i < chunk.size(); ++i) {
      // The point's number is in its colour.
      const std::size_t number = chunk.colors[3 * i] + 256U * chunk.colors[3 * i + 1];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double metres =
            2.0 * chunk.cell.at(axis) + chunk.positions[3 * i + axis] * 2.0 / 65536;
        EXPECT_NEAR(metres, cloud.positions[number][static_cast<int>(axis)], 4e-5);
      }
      ++found;
    }
  }
  EXPECT_EQ(found, cloud.size());
}

TEST(PointChunks, AddedPointsFollowThePresentOnes) {
  const PointCloud cloud = random_cloud(500);
  PointChunks chunks;
  chunks.add(cloud);
  const std::vector<PointChunk> before = chunks.chunks();
  chunks.add(random_cloud(300));
  for (std::size_t i = 0; i < before.size(); ++i) {
    const PointChunk& now = chunks.chunks()[i];
    ASSERT_GE(now.size(), before[i].size());
    EXPECT_EQ(now.cell, before[i].cell);
    EXPECT_TRUE(
        std::equal(before[i].positions.begin(), before[i].positions.end(), now.positions.begin()));
  }
}

TEST(PointChunks, LeavesOutWhatIsNowhere) {
  PointCloud cloud = random_cloud(3);
  cloud.positions[0].x() = std::numeric_limits<float>::quiet_NaN();
  cloud.positions[1].y() = std::numeric_limits<float>::infinity();
  cloud.positions[2].z() = 1e9F;
  PointChunks chunks;
  chunks.add(cloud);
  EXPECT_EQ(chunks.size(), 0U);
}

}  // namespace
}  // namespace stillmap
