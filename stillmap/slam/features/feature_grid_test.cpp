// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/feature_grid.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/feature_images.hpp"

namespace stillmap {
namespace {

std::vector<std::uint32_t> visited(const FeatureGrid& grid, Eigen::Vector2f center, float radius) {
  std::vector<std::uint32_t> order;
  grid.visit_near(center, radius, [&](std::uint32_t i) { order.push_back(i); });
  return order;
}

// The cell of 16 px that a position falls into; what lies outside counts as at the border.
std::pair<int, int> cell_of(const Eigen::Vector2f& p, int width, int height) {
  const auto index = [](float x, int length) {
    return std::clamp(static_cast<int>(std::floor(x / 16)), 0, (length + 15) / 16 - 1);
  };
  return {index(p.y(), height), index(p.x(), width)};
}

// Random points, many of them outside the image, and queries all over the place.
TEST(FeatureGrid, VisitsTheCellsThatTheSquareTouchesInOrder) {
  for (const auto& [width, height] : {std::pair{640, 480}, {50, 37}, {16, 16}, {5, 3}}) {
    TestDice dice(static_cast<std::uint32_t>(width));
    std::vector<Eigen::Vector2f> points;
    for (int i = 0; i < 500; ++i) points.push_back(dice.point(-40, width + 40.0F, height + 40.0F));
    const FeatureGrid grid(points, width, height);
    for (int query = 0; query < 300; ++query) {
      const Eigen::Vector2f center = dice.point(-100, width + 100.0F, height + 100.0F);
      const float radius = dice.uniform(0, 60);
      const auto [r0, c0] = cell_of(center.array() - radius, width, height);
      const auto [r1, c1] = cell_of(center.array() + radius, width, height);
      std::vector<std::pair<std::pair<int, int>, std::uint32_t>> expected;
      for (std::uint32_t i = 0; i < points.size(); ++i) {
        const auto [r, c] = cell_of(points[i], width, height);
        if (r >= r0 && r <= r1 && c >= c0 && c <= c1) expected.push_back({{r, c}, i});
      }
      std::ranges::sort(expected);
      std::vector<std::uint32_t> order;
      for (const auto& [cell, i] : expected) order.push_back(i);
      ASSERT_EQ(visited(grid, center, radius), order);
    }
  }
}

TEST(FeatureGrid, MissesNoPointWithinTheRadius) {
  TestDice dice(7);
  std::vector<Eigen::Vector2f> points;
  for (int i = 0; i < 1000; ++i) points.push_back(dice.point(-30, 670, 510));
  const FeatureGrid grid(points, 640, 480);
  for (int query = 0; query < 500; ++query) {
    const Eigen::Vector2f center = dice.point(-50, 690, 530);
    const float radius = dice.uniform(0, 80);
    const std::vector<std::uint32_t> order = visited(grid, center, radius);
    const std::set<std::uint32_t> found(order.begin(), order.end());
    ASSERT_EQ(found.size(), order.size()) << "a point was visited twice";
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if ((points[i] - center).norm() > radius) continue;
      ASSERT_TRUE(found.contains(i));
    }
  }
}

TEST(FeatureGrid, EmptyGridsVisitNothing) {
  EXPECT_TRUE(visited({}, {1, 1}, 100).empty());
  EXPECT_TRUE(visited(FeatureGrid({}, 640, 480), {1, 1}, 1000).empty());
  EXPECT_TRUE(visited(FeatureGrid({}, 0, 0), {1, 1}, 1000).empty());
}

TEST(FeatureGrid, PositionsThatAreNoNumbersDoNoHarm) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<Eigen::Vector2f> points = {{nan, nan}, {inf, -inf}, {3e38F, 5}, {100, 100}};
  const FeatureGrid grid(points, 640, 480);
  EXPECT_THAT(visited(grid, {100, 100}, 5), testing::ElementsAre(3));
  EXPECT_EQ(visited(grid, {100, 100}, inf).size(), 4U);
}

}  // namespace
}  // namespace stillmap
