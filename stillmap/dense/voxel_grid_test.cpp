// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/voxel_grid.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "tests/support/brute_force_thinning.hpp"

namespace stillmap {
namespace {

PointCloud thin(const PointCloud& points, double voxel_size_m) {
  VoxelGrid grid(voxel_size_m);
  for (std::size_t i = 0; i < points.size(); ++i) {
    grid.add(points.positions[i], points.colors[i], points.labels[i]);
  }
  return grid.extract();
}

void expect_near(const PointCloud& actual, const PointCloud& expected, float tolerance_m) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    ASSERT_LT((actual.positions[i] - expected.positions[i]).norm(), tolerance_m) << "point " << i;
  }
  EXPECT_EQ(actual.colors, expected.colors);
  EXPECT_EQ(actual.labels, expected.labels);
}

TEST(VoxelGrid, AgreesWithBruteForceWhereVoxelsHoldManyPoints) {
  const PointCloud points = random_cloud(50000, 1.0, 1);
  const PointCloud thinned = thin(points, 0.1);
  EXPECT_GT(thinned.size(), 7000U);
  expect_near(thinned, brute_force_thinning(points, 0.1), 1e-6F);
}

TEST(VoxelGrid, AgreesWithBruteForceWhereTheTableGrowsOften) {
  const PointCloud points = random_cloud(100000, 20.0, 2);
  const PointCloud thinned = thin(points, 0.05);
  EXPECT_GT(thinned.size(), 99000U);
  expect_near(thinned, brute_force_thinning(points, 0.05), 1e-5F);
}

TEST(VoxelGrid, IsTheSameBitsEachTime) {
  const PointCloud points = random_cloud(30000, 1.0, 3);
  const PointCloud first = thin(points, 0.07);
  const PointCloud second = thin(points, 0.07);
  EXPECT_EQ(first.positions, second.positions);
  EXPECT_EQ(first.colors, second.colors);
  EXPECT_EQ(first.labels, second.labels);
}

TEST(VoxelGrid, OrdersVoxelsAlikeWhateverTheOrderOfThePoints) {
  const PointCloud points = random_cloud(30000, 1.0, 4);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  PointCloud shuffled;
  for (const std::size_t i : order) {
    shuffled.positions.push_back(points.positions[i]);
    shuffled.colors.push_back(points.colors[i]);
    shuffled.labels.push_back(points.labels[i]);
  }
  expect_near(thin(shuffled, 0.1), thin(points, 0.1), 1e-6F);
}

TEST(VoxelGrid, MeansOfOneVoxelWorkedByHand) {
  VoxelGrid grid(1.0);
  grid.add({-0.75F, 2.25F, 0.0F}, {0, 10, 255});
  grid.add({-0.25F, 2.75F, 0.5F}, {1, 20, 255});
  grid.add({-0.5F, 2.0F, 0.25F}, {1, 31, 254}, 0, 2);
  const PointCloud cloud = grid.extract();
  ASSERT_EQ(cloud.size(), 1U);
  EXPECT_EQ(cloud.positions[0], Eigen::Vector3f(-0.5F, 2.25F, 0.25F));
  EXPECT_EQ(cloud.colors[0], (Rgb{1, 23, 255}));  // 0.75, 23, 254.5
  EXPECT_TRUE(cloud.labels.empty());
}

TEST(VoxelGrid, EmptyWithoutPoints) {
  const VoxelGrid grid(0.01);
  EXPECT_EQ(grid.size(), 0U);
  EXPECT_TRUE(grid.extract().empty());
}

TEST(VoxelGrid, IgnoresWhatIsNotFiniteOrTooFar) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  VoxelGrid grid(1.0);
  for (const float bad : {kNan, kInfinity, -kInfinity, 1048576.0F, -1048577.0F, 3e38F, -3e38F}) {
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3f p(0.5F, 0.5F, 0.5F);
      p[axis] = bad;
      grid.add(p, {9, 9, 9}, 9);
    }
  }
  EXPECT_EQ(grid.size(), 0U);
}

TEST(VoxelGrid, KeepsTheOutermostVoxels) {
  VoxelGrid grid(1.0);
  grid.add({1048575.5F, 1048575.5F, 1048575.5F}, {1, 1, 1});
  grid.add({-1048576.0F, -1048576.0F, -1048576.0F}, {2, 2, 2});
  const PointCloud cloud = grid.extract();
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.positions[0], Eigen::Vector3f::Constant(-1048576.0F));
  EXPECT_EQ(cloud.positions[1], Eigen::Vector3f::Constant(1048575.5F));
  EXPECT_EQ(cloud.colors[1], (Rgb{1, 1, 1}));
}

TEST(VoxelGrid, AFullVoxelKeepsItsMean) {
  VoxelGrid grid(1.0);
  for (int i = 0; i < 65535; ++i) grid.add({0.25F, 0.25F, 0.25F}, {255, 255, 255}, 7);
  for (int i = 0; i < 100000; ++i) grid.add({0.75F, 0.75F, 0.75F}, {0, 0, 0}, 1);
  const PointCloud cloud = grid.extract();
  ASSERT_EQ(cloud.size(), 1U);
  EXPECT_EQ(cloud.positions[0], Eigen::Vector3f::Constant(0.25F));
  EXPECT_EQ(cloud.colors[0], (Rgb{255, 255, 255}));
  EXPECT_EQ(cloud.labels[0], 7);
}

TEST(VoxelGrid, RefusesASizeThatIsNone) {
  EXPECT_THROW(VoxelGrid(0.0), InternalError);
  EXPECT_THROW(VoxelGrid(-1.0), InternalError);
  EXPECT_THROW(VoxelGrid{std::numeric_limits<double>::quiet_NaN()}, InternalError);
}

}  // namespace
}  // namespace stillmap
