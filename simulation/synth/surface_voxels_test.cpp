// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/surface_voxels.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

// The same on every standard library.
float uniform(std::mt19937& rng, float low, float high) {
  return low + (high - low) * static_cast<float>(rng() >> 8U) * 0x1p-24F;
}

PointCloud random_cloud(std::size_t size, float extent, std::uint32_t seed) {
  std::mt19937 rng(seed);
  PointCloud cloud;
  for (std::size_t i = 0; i < size; ++i) {
    const float x = uniform(rng, -extent, extent), y = uniform(rng, -extent, extent);
    cloud.positions.emplace_back(x, y, uniform(rng, -extent, extent));
    cloud.colors.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8U), 7});
  }
  return cloud;
}

SurfaceVoxels filled(const PointCloud& cloud, double voxel_size_m) {
  SurfaceVoxels voxels(voxel_size_m);
  for (std::size_t i = 0; i < cloud.size(); ++i) voxels.add(cloud.positions[i], cloud.colors[i]);
  return voxels;
}

TEST(SurfaceVoxels, KeepThePointNearestToEachCentre) {
  const PointCloud cloud = random_cloud(20000, 0.9F, 3);
  // By the definition, with another container and doubles.
  std::map<std::array<int, 3>, std::pair<double, std::size_t>> expected;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Array3d scaled = cloud.positions[i].cast<double>().array() * 16.0;
    const Eigen::Array3d cell = scaled.floor();
    const double distance = (scaled - cell - 0.5).matrix().squaredNorm();
    const std::array<int, 3> key = {
        static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())};
    const auto [entry, is_new] = expected.try_emplace(key, distance, i);
    if (!is_new && distance < entry->second.first) entry->second = {distance, i};
  }
  const SurfaceVoxels voxels = filled(cloud, 1.0 / 16.0);
  const PointCloud thinned = voxels.extract();
  ASSERT_EQ(thinned.size(), expected.size());
  EXPECT_EQ(voxels.size(), expected.size());
  EXPECT_LT(thinned.size(), 18000U);
  std::size_t at = 0;
  for (const auto& [key, nearest] : expected) {  // a map is in the order of x, y, z
    EXPECT_EQ(thinned.positions[at], cloud.positions[nearest.second]);
    EXPECT_EQ(thinned.colors[at], cloud.colors[nearest.second]);
    ++at;
  }
}

TEST(SurfaceVoxels, KeepTheFirstOfEquals) {
  SurfaceVoxels voxels(1.0);
  voxels.add({0.25F, 0.5F, 0.5F}, {1, 0, 0});
  voxels.add({0.75F, 0.5F, 0.5F}, {2, 0, 0});
  voxels.add({-0.25F, 0.5F, 0.5F}, {3, 0, 0});
  const PointCloud cloud = voxels.extract();
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.colors[0][0], 3) << "the voxel below zero comes first";
  EXPECT_EQ(cloud.colors[1][0], 1);
}

TEST(SurfaceVoxels, RefuseWhatIsNowhere) {
  SurfaceVoxels voxels(0.01);
  EXPECT_THROW(voxels.add({0.F, 1e6F, 0.F}, {}), InternalError);
  EXPECT_THROW(voxels.add({0.F, 0.F, std::numeric_limits<float>::quiet_NaN()}, {}), InternalError);
  EXPECT_THROW(SurfaceVoxels(0.0), InternalError);
}

TEST(PointsClearOf, AreThoseThatBruteForceFinds) {
  const PointCloud cloud = random_cloud(3000, 0.5F, 4), others = random_cloud(3000, 0.5F, 5);
  const double clearance = 0.05;
  std::vector<Eigen::Vector3f> expected;
  for (const Eigen::Vector3f& p : cloud.positions) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3f& q : others.positions) {
      nearest = std::min(nearest, (p.cast<double>() - q.cast<double>()).norm());
    }
    if (nearest > clearance) expected.push_back(p);
  }
  const PointCloud clear = points_clear_of(cloud, others, clearance);
  EXPECT_EQ(clear.positions, expected);
  EXPECT_EQ(clear.colors.size(), expected.size());
  EXPECT_GT(expected.size(), 300U);
  EXPECT_LT(expected.size(), 2700U);
}

TEST(PointsClearOf, LimitAndEmptyClouds) {
  PointCloud one, other;
  one.positions = {{0.F, 0.F, 0.F}, {0.F, 0.F, 0.0625F}};
  one.colors = {{1, 2, 3}, {4, 5, 6}};
  other.positions = {{0.F, 0.F, -0.0625F}};
  other.colors = {{0, 0, 0}};
  const PointCloud clear = points_clear_of(one, other, 0.0625);
  ASSERT_EQ(clear.size(), 1U) << "a point at the very distance is too near";
  EXPECT_EQ(clear.colors[0][0], 4);
  EXPECT_EQ(points_clear_of(one, PointCloud(), 0.05).size(), 2U);
  EXPECT_TRUE(points_clear_of(PointCloud(), one, 0.05).empty());
}

}  // namespace
}  // namespace stillmap
