// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/voxel_walk.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

std::vector<Eigen::Vector3i> walk(const Eigen::Vector3d& from,
                                  const Eigen::Vector3d& to,
                                  double edge_m) {
  std::vector<Eigen::Vector3i> voxels;
  for (VoxelWalk walk(from, to, edge_m);; walk.advance()) {
    voxels.push_back(walk.voxel());
    if (walk.at_end()) return voxels;
  }
}

TEST(VoxelWalk, PassesAPlaneLineAsDrawnByHand) {
  // From the middle of (0, 0) to the middle of (2, 1): crosses x = 1 at y = 0.75, y = 1 at x = 1.5.
  const std::vector<Eigen::Vector3i> expected = {{0, 0, -1}, {1, 0, -1}, {1, 1, -1}, {2, 1, -1}};
  EXPECT_EQ(walk({0.25, 0.25, -0.25}, {1.25, 0.75, -0.25}, 0.5), expected);
}

TEST(VoxelWalk, StaysInOneVoxel) {
  EXPECT_EQ(walk({0.1, 0.1, 0.1}, {0.9, 0.2, 0.3}, 1).size(), 1U);
  EXPECT_EQ(walk({0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}, 1).size(), 1U);
}

TEST(VoxelWalk, PassesWhatDenseSamplesOfTheLinePass) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> draw(-2, 2);
  for (int line = 0; line < 200; ++line) {
    const Eigen::Vector3d from(draw(rng), draw(rng), draw(rng));
    const Eigen::Vector3d to(draw(rng), draw(rng), draw(rng));
    const std::vector<Eigen::Vector3i> voxels = walk(from, to, 0.1);
    EXPECT_EQ(voxels.front(), voxel_of(from, 0.1));
    EXPECT_EQ(voxels.back(), voxel_of(to, 0.1));
    for (std::size_t i = 1; i < voxels.size(); ++i) {
      ASSERT_EQ((voxels[i] - voxels[i - 1]).cwiseAbs().sum(), 1);
    }
    for (int i = 0; i <= 2000; ++i) {
      const Eigen::Vector3i sample = voxel_of(from + i / 2000.0 * (to - from), 0.1);
      ASSERT_NE(std::ranges::find(voxels, sample), voxels.end());
    }
  }
}

TEST(VoxelWalk, EndsAlsoWhereALineRunsAlongEdges) {
  EXPECT_EQ(walk({0, 0, 0}, {-3, 3, 0}, 1).back(), Eigen::Vector3i(-3, 3, 0));
  EXPECT_EQ(walk({0.3, 0.3, 0.3}, {0.6, 0.6, 0.6}, 0.1).back(), voxel_of({0.6, 0.6, 0.6}, 0.1));
}

}  // namespace
}  // namespace stillmap
