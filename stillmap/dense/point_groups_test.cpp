// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/point_groups.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace stillmap {
namespace {

TEST(PointGroups, AgreeWithAMapOfCells) {
  std::mt19937 rng(8);
  std::uniform_real_distribution<float> coordinate(-1.0F, 1.0F);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 5000; ++i) {
    points.emplace_back(coordinate(rng), coordinate(rng), coordinate(rng));
  }
  const PointGroups groups = group_points(points, 0.2);
  std::map<std::array<int, 3>, std::vector<std::size_t>> cells;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<int, 3> cell{};
    for (int a = 0; a < 3; ++a) {
      cell[static_cast<std::size_t>(a)] =
          static_cast<int>(std::floor(static_cast<double>(points[i][a]) / 0.2));
    }
    cells[cell].push_back(i);
  }
  ASSERT_EQ(groups.means.size(), cells.size());
  ASSERT_EQ(groups.group_of.size(), points.size());
  for (const auto& [cell, members] : cells) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const std::uint32_t group = groups.group_of[members[0]];
    for (const std::size_t i : members) {
      EXPECT_EQ(groups.group_of[i], group);
      sum += points[i].cast<double>();
    }
    const Eigen::Vector3f mean = (sum / static_cast<double>(members.size())).cast<float>();
    EXPECT_LT((groups.means[group] - mean).norm(), 1e-6F);
  }
}

TEST(PointGroups, NeighboursFollow) {
  std::vector<Eigen::Vector3f> points;
  for (int x = 0; x < 32; ++x) {
    for (int y = 0; y < 32; ++y) {
      for (int z = 0; z < 32; ++z) {
        points.emplace_back(static_cast<float>(x) + 0.5F,
                            static_cast<float>(y) + 0.5F,
                            static_cast<float>(z) + 0.5F);
      }
    }
  }
  const PointGroups groups = group_points(points, 1.0);
  ASSERT_EQ(groups.means.size(), points.size());
  for (std::size_t begin = 0; begin < points.size(); begin += 512) {  // cubes of 8
    Eigen::AlignedBox3f box;
    for (std::size_t i = begin; i < begin + 512; ++i) box.extend(groups.means[i]);
    EXPECT_EQ(box.sizes(), Eigen::Vector3f(7, 7, 7));
  }
}

TEST(PointGroups, WhatHasNoPlaceIsOneGroup) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Eigen::Vector3f> points{{nan, 0, 0}, {1, 1, 1}, {0, 1e30F, 0}};
  const PointGroups groups = group_points(points, 0.1);
  EXPECT_EQ(groups.means.size(), 2U);
  EXPECT_EQ(groups.group_of[0], groups.group_of[2]);
  EXPECT_NE(groups.group_of[0], groups.group_of[1]);
  EXPECT_TRUE(group_points({}, 0.1).means.empty());
}

}  // namespace
}  // namespace stillmap
