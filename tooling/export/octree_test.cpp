// SPDX-License-Identifier: Apache-2.0
// What is written, read by the OctoMap library itself.
#include "tooling/export/octree.hpp"

#include <memory>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

namespace stillmap {
namespace {

using testing::StartsWith;

ObservedSpace ray() {
  return {.resolution_m = 0.1,
          .voxels = {{{0, 0, 0}, 0, 1},
                     {{1, 0, 0}, 0, 3},
                     {{2, 0, 0}, 4, 1},
                     {{-7, 5, -9}, 1, 0},
                     {{1, 9, 9}, 0, 1000},
                     {{9, 9, 9}, 1, 1000}}};
}

TEST(EncodeOctree, BinaryIsReadByOctoMap) {
  std::stringstream stream(encode_octree(ray(), OctreeFormat::kBinary));
  octomap::OcTree tree(1.0);
  ASSERT_TRUE(tree.readBinary(stream));
  EXPECT_EQ(tree.getResolution(), 0.1);
  const auto occupied = [&](double x, double y, double z) -> int {
    const octomap::OcTreeNode* node = tree.search(x, y, z);
    return node == nullptr ? -1 : tree.isNodeOccupied(node) ? 1 : 0;
  };
  EXPECT_EQ(occupied(0.05, 0.05, 0.05), 0);
  EXPECT_EQ(occupied(0.15, 0.05, 0.05), 0);
  EXPECT_EQ(occupied(0.25, 0.05, 0.05), 1);   // the end of the ray
  EXPECT_EQ(occupied(0.35, 0.05, 0.05), -1);  // behind it
  EXPECT_EQ(occupied(-0.65, 0.55, -0.85), 1);
  EXPECT_EQ(occupied(-0.55, 0.55, -0.85), -1);
}

TEST(EncodeOctree, FullIsReadByOctoMapWithProbabilities) {
  const std::string bytes = encode_octree(ray(), OctreeFormat::kFull);
  EXPECT_THAT(bytes, StartsWith("# Octomap OcTree file\n"));
  std::stringstream stream(bytes);
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(stream));
  const auto* tree = dynamic_cast<octomap::OcTree*>(read.get());
  ASSERT_NE(tree, nullptr);
  const auto probability = [&](double x, double y, double z) {
    const octomap::OcTreeNode* node = tree->search(x, y, z);
    return node == nullptr ? -1.0 : node->getOccupancy();
  };
  EXPECT_NEAR(probability(0.05, 0.05, 0.05), 0.4, 1e-6);
  // Three misses: odds (2/3)^3 = 8/27, so 8/35.
  EXPECT_NEAR(probability(0.15, 0.05, 0.05), 8.0 / 35.0, 1e-6);
  EXPECT_NEAR(probability(0.25, 0.05, 0.05), 0.7, 1e-6);
  EXPECT_NEAR(probability(-0.65, 0.55, -0.85), 0.7, 1e-6);   // seen by none, yet in the map
  EXPECT_NEAR(probability(0.15, 0.95, 0.95), 0.1192, 1e-4);  // OctoMap's bounds
  EXPECT_NEAR(probability(0.95, 0.95, 0.95), 0.971, 1e-4);
  EXPECT_EQ(probability(0.35, 0.05, 0.05), -1.0);
}

TEST(EncodeOctree, EqualSpaceIsOneLeaf) {
  ObservedSpace space{.resolution_m = 0.1, .voxels = {}};
  for (int i = 0; i < 8; ++i) space.voxels.push_back({{i & 1, (i >> 1) & 1, i >> 2}, 0, 2});
  std::stringstream stream(encode_octree(space, OctreeFormat::kFull));
  const std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(stream));
  ASSERT_NE(tree, nullptr);
  EXPECT_EQ(tree->size(), 16U);  // 15 inner nodes down to a leaf of 20 cm, itself included
}

TEST(EncodeOctree, IsTheSameToTheByte) {
  for (const OctreeFormat format : {OctreeFormat::kBinary, OctreeFormat::kFull}) {
    EXPECT_EQ(encode_octree(ray(), format), encode_octree(ray(), format));
  }
}

TEST(EncodeOctree, OfNothingIsAnEmptyTree) {
  std::stringstream stream(encode_octree({}, OctreeFormat::kFull));
  const std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(stream));
  ASSERT_NE(tree, nullptr);
  EXPECT_EQ(tree->size(), 0U);
}

}  // namespace
}  // namespace stillmap
