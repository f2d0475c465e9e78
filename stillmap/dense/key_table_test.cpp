// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/key_table.hpp"

#include <map>
#include <random>

#include <gtest/gtest.h>

#include "stillmap/dense/cube_moves.hpp"

namespace stillmap {
namespace {

TEST(KeyTable, NumbersKeysAsATreeWould) {
  std::mt19937_64 random(3);
  KeyTable table;
  std::map<std::uint64_t, std::uint32_t> tree;
  for (int i = 0; i < 50000; ++i) {
    const std::uint64_t key = random() % 20000 << (i % 3 * 21);
    const auto [at, is_new] = tree.emplace(key, static_cast<std::uint32_t>(tree.size()));
    ASSERT_EQ(table.find(key), is_new ? KeyTable::kNone : at->second);
    ASSERT_EQ(table.find_or_add(key), at->second);
    ASSERT_EQ(table.size(), tree.size());
  }
  EXPECT_GT(tree.size(), 20000U);
}

TEST(CubeMoves, PointsOfACubeMoveOntoItsPlane) {
  CubeMoves moves(0.1);
  moves.add({{0.05F, 0.05F, 0.05F}, {0, 0, 0.02F}, {0, 0, 1}});
  moves.add({{0.05F, 0.05F, 0.06F}, {1, 1, 1}});  // the first counts
  moves.add({{-0.05F, 0.05F, 0.05F}, {0.01F, 0, 0}});
  const auto moved = [&](const Eigen::Vector3f& p) { return Eigen::Vector3f(p + moves.at(p)); };
  EXPECT_TRUE(moved({0.01F, 0.09F, 0.03F}).isApprox(Eigen::Vector3f(0.01F, 0.09F, 0.07F)));
  EXPECT_TRUE(moved({0.09F, 0.02F, 0.09F}).isApprox(Eigen::Vector3f(0.09F, 0.02F, 0.07F)));
  EXPECT_TRUE(moved({-0.09F, 0.02F, 0.09F}).isApprox(Eigen::Vector3f(-0.08F, 0.02F, 0.09F)));
  EXPECT_EQ(moves.at({0.15F, 0.05F, 0.05F}), Eigen::Vector3f::Zero());
}

}  // namespace
}  // namespace stillmap
