// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/map_quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/dense/voxel_grid.hpp"
#include "stillmap/geometry/se3.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;

void add(PointCloud& cloud, double x, double y, double z) {
  cloud.positions.push_back(Eigen::Vector3d(x, y, z).cast<float>());
  cloud.colors.push_back({});
}

// Centres of nx * ny 2 cm voxels side by side from voxel (x0, y0, z0) on.
void add_tiles(PointCloud& cloud, const Eigen::Vector3i& first, int nx, int ny) {
  for (int x = 0; x < nx; ++x) {
    for (int y = 0; y < ny; ++y) {
      const Eigen::Vector3d voxel = (first + Eigen::Vector3i(x, y, 0)).cast<double>();
      const Eigen::Vector3d p = 0.02 * (voxel + Eigen::Vector3d::Constant(0.5));
      add(cloud, p.x(), p.y(), p.z());
    }
  }
}

PointCloud tiles(int x0, int y0, int z0, int nx, int ny) {
  PointCloud cloud;
  add_tiles(cloud, {x0, y0, z0}, nx, ny);
  return cloud;
}

TEST(MapQuality, OfThePerfectMapIsPerfect) {
  const PointCloud wall = tiles(0, 0, 0, 20, 10);
  const MapQuality quality = map_quality(wall, {wall, tiles(0, 0, 50, 5, 5)});
  EXPECT_EQ(quality.voxels, 200U);
  EXPECT_EQ(quality.sa, 1.0);
  EXPECT_EQ(quality.da, 1.0);
  EXPECT_EQ(quality.aa, 1.0);
  EXPECT_EQ(quality.ha, 1.0);
  EXPECT_EQ(quality.accuracy_m, 0.0);
  EXPECT_EQ(quality.completeness_m, 0.0);
  EXPECT_EQ(quality.off_ratio_5cm, 0.0);
  EXPECT_EQ(quality.off_ratio_10cm, 0.0);
  EXPECT_EQ(quality.ghosts->ratio, 0.0);
  EXPECT_EQ(quality.ghosts->volume_l, 0.0);
  EXPECT_EQ(quality.ghosts->clusters, 0U);
}

// Four static points on the x axis; the map has one exact, one 4 cm off, one 8 cm off, one 20 cm.
TEST(MapQuality, HasTheFiguresWorkedOutByHand) {
  PointCloud truth, dynamic, map;
  for (const double x : {0.01, 1.01, 2.01, 3.01}) add(truth, x, 0.01, 0.01);
  add(map, 0.01, 0.01, 0.01);
  add(map, 1.01, 0.05, 0.01);
  add(map, 2.01, 0.09, 0.01);
  add(map, 3.01, 0.21, 0.01);
  add(dynamic, 3.01, 0.25, 0.01);  // 4 cm from the fourth map point: a ghost
  add(dynamic, 1.01, 0.09, 0.01);  // 4 cm from the second, which is near static truth: no ghost
  add(dynamic, 9.01, 0.01, 0.01);  // free in the map
  add(dynamic, 8.01, 0.01, 0.01);  // free in the map
  add(dynamic, 7.01, 0.01, 0.01);  // free in the map
  const MapQuality quality = map_quality(map, {truth, dynamic});
  EXPECT_DOUBLE_EQ(quality.sa, 0.5);
  EXPECT_DOUBLE_EQ(*quality.da, 0.6);
  EXPECT_DOUBLE_EQ(*quality.aa, std::sqrt(0.3));
  EXPECT_DOUBLE_EQ(*quality.ha, 0.6 / 1.1);
  EXPECT_NEAR(*quality.accuracy_m, (0 + 0.04 + 0.08 + 0.20) / 4, 1e-7);
  EXPECT_NEAR(*quality.completeness_m, (0 + 0.04 + 0.08 + 0.20) / 4, 1e-7);
  EXPECT_DOUBLE_EQ(*quality.off_ratio_5cm, 0.5);
  EXPECT_DOUBLE_EQ(*quality.off_ratio_10cm, 0.25);
  EXPECT_DOUBLE_EQ(*quality.ghosts->ratio, 0.25);
  EXPECT_NEAR(quality.ghosts->volume_l, 0.008, 1e-12);
}

// A chair that stood at rest last: a map with it there and a map without it are equally good.
TEST(MapQuality, ThingsAtTheirRestingPlacesCountOnNeitherSide) {
  const PointCloud wall = tiles(0, 0, 0, 20, 10), swept = tiles(0, 0, 50, 20, 10);
  const PointCloud chair = tiles(0, 0, 50, 4, 10);
  PointCloud with_chair = wall;
  add_tiles(with_chair, {0, 0, 50}, 4, 10);
  const MapTruth truth{wall, swept, chair};
  for (const PointCloud& map : {wall, with_chair}) {
    const MapQuality quality = map_quality(map, truth);
    EXPECT_EQ(quality.voxels, 200U);
    EXPECT_EQ(quality.sa, 1.0);
    EXPECT_EQ(quality.da, 1.0);
    EXPECT_EQ(quality.accuracy_m, 0.0);
    EXPECT_EQ(quality.ghosts->ratio, 0.0);
  }
  EXPECT_GT(map_quality(with_chair, {wall, swept}).ghosts->ratio, 0.1);
  // Elsewhere it is a ghost all the same; 5 cm around the place do not count.
  PointCloud elsewhere = wall;
  add_tiles(elsewhere, {10, 0, 50}, 4, 10);
  EXPECT_NEAR(*map_quality(elsewhere, truth).ghosts->ratio, 40.0 / 240, 1e-12);
  // What is near static truth counts, though a thing stands there, too.
  PointCloud at_the_wall;
  add_tiles(at_the_wall, {0, 0, 2}, 4, 10);
  EXPECT_EQ(map_quality(wall, {wall, swept, at_the_wall}).voxels, 200U);
}

TEST(MapQuality, CountsClustersOfFiftyGhostVoxelsThatTouch) {
  const PointCloud wall = tiles(0, 0, 0, 5, 5);
  PointCloud ghosts;
  add_tiles(ghosts, {0, 0, 50}, 7, 7);  // with the next: 50, touching by a corner
  add_tiles(ghosts, {7, 7, 51}, 1, 1);
  add_tiles(ghosts, {100, 0, 50}, 7, 7);   // 49
  add_tiles(ghosts, {-100, 0, 50}, 5, 5);  // 50 in two halves, a voxel apart
  add_tiles(ghosts, {-94, 0, 50}, 5, 5);
  add_tiles(ghosts, {0, 100, 50}, 10, 5);  // 50
  PointCloud map = ghosts;
  add_tiles(map, {0, 0, 0}, 5, 5);
  const MapQuality quality = map_quality(map, {wall, ghosts});
  EXPECT_EQ(quality.ghosts->clusters, 2U);
  EXPECT_NEAR(quality.ghosts->volume_l, 0.008 * 199, 1e-9);
  EXPECT_DOUBLE_EQ(*quality.ghosts->ratio, 199.0 / 224.0);
  EXPECT_EQ(quality.da, 0.0);
  EXPECT_EQ(quality.aa, 0.0);
}

TEST(MapQuality, OfAMapIsThatOfTheMovedMap) {
  PointCloud wall = tiles(0, 0, 0, 20, 10);
  wall.normals.assign(wall.size(), Eigen::Vector3f::UnitX());
  const Eigen::Isometry3d T_truth_map =
      make_pose(so3_exp({0, 0, 0.5 * std::numbers::pi}), Eigen::Vector3d(5, -3, 1));
  const PointCloud map = moved(wall, T_truth_map.inverse());
  EXPECT_LT((map.normals[0] + Eigen::Vector3f::UnitY()).norm(), 1e-6);
  EXPECT_LT(*map_quality(moved(map, T_truth_map), {wall, {}}).accuracy_m, 1e-6);
  EXPECT_GT(*map_quality(map, {wall, {}}).accuracy_m, 1.0);
}

TEST(MapQuality, LeavesOutWhatIsNotKnown) {
  const PointCloud wall = tiles(0, 0, 0, 5, 5);
  const MapQuality of_nothing = map_quality({}, {wall, wall});
  EXPECT_EQ(of_nothing.sa, 0.0);
  EXPECT_EQ(of_nothing.da, 1.0);
  EXPECT_EQ(of_nothing.ha, 0.0);
  EXPECT_FALSE(of_nothing.accuracy_m || of_nothing.completeness_m || of_nothing.off_ratio_5cm);
  EXPECT_FALSE(of_nothing.ghosts->ratio);
  EXPECT_EQ(of_nothing.ghosts->clusters, 0U);

  const MapQuality without_dynamic = map_quality(wall, {wall, std::nullopt});
  EXPECT_FALSE(without_dynamic.da || without_dynamic.aa || without_dynamic.ghosts);
  const MapQuality nothing_moved = map_quality(wall, {wall, PointCloud()});
  EXPECT_FALSE(nothing_moved.da || nothing_moved.aa || nothing_moved.ha);
  EXPECT_EQ(nothing_moved.ghosts->ratio, 0.0);
}

TEST(MapQuality, RefusesPointsThatAreNoPlace) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float bad : {nan, std::numeric_limits<float>::infinity(), 10001.0F, -1e30F}) {
    PointCloud cloud = tiles(0, 0, 0, 2, 1);
    cloud.positions[1].y() = bad;
    EXPECT_THAT(error_of([&] { check_extent(cloud, "a.ply"); }), HasSubstr("a.ply: point 1 is at"));
  }
  check_extent(tiles(0, 0, 0, 2, 1), "a.ply");
}

// ---- every figure against its definition, written down as plainly as can be ----

double nearest(const std::vector<Eigen::Vector3f>& cloud, const Eigen::Vector3f& p) {
  double best = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3f& q : cloud) {
    best = std::min(best, (p.cast<double>() - q.cast<double>()).norm());
  }
  return best;
}

std::vector<Eigen::Vector3f> thin(const PointCloud& cloud) {
  VoxelGrid grid(0.02);
  for (const Eigen::Vector3f& p : cloud.positions) grid.add(p, {});
  return grid.extract().positions;
}

// Joins the groups of all pairs that touch until nothing changes.
std::size_t clusters(const std::vector<Eigen::Vector3f>& ghosts) {
  std::vector<std::size_t> group(ghosts.size());
  std::vector<Eigen::Array3d> voxels;
  for (std::size_t i = 0; i < ghosts.size(); ++i) {
    group[i] = i;
    voxels.emplace_back((ghosts[i].cast<double>() / 0.02).array().floor());
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < ghosts.size(); ++i) {
      for (std::size_t j = 0; j < ghosts.size(); ++j) {
        if (group[j] <= group[i] || (voxels[i] - voxels[j]).abs().maxCoeff() > 1) continue;
        group[j] = group[i];
        changed = true;
      }
    }
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < ghosts.size(); ++i) count += std::ranges::count(group, i) >= 50;
  return count;
}

PointCloud random_cloud(std::size_t count, const Eigen::Vector3d& size, std::mt19937& random) {
  PointCloud cloud;
  const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  for (std::size_t i = 0; i < count; ++i) {
    const double x = unit(), y = unit(), z = unit();
    add(cloud, x * size.x(), y * size.y(), z * size.z());
  }
  return cloud;
}

class RandomClouds : public testing::TestWithParam<std::uint32_t> {};

TEST_P(RandomClouds, AgreeWithBruteForce) {
  std::mt19937 random(GetParam());
  const PointCloud map_cloud = random_cloud(1500, {0.5, 0.4, 0.2}, random);
  const PointCloud static_cloud = random_cloud(40, {0.4, 0.4, 0.3}, random);
  const PointCloud dynamic_cloud = random_cloud(150, {0.5, 0.4, 0.3}, random);
  const std::vector<Eigen::Vector3f> map = thin(map_cloud), surface = thin(static_cloud),
                                     dynamic = thin(dynamic_cloud);
  double sa = 0, da = 0, accuracy = 0, completeness = 0, off5 = 0, off10 = 0;
  std::vector<Eigen::Vector3f> ghosts;
  for (const Eigen::Vector3f& p : surface) {
    sa += nearest(map, p) <= 0.05;
    completeness += nearest(map, p);
  }
  for (const Eigen::Vector3f& p : dynamic) da += nearest(map, p) > 0.05;
  for (const Eigen::Vector3f& p : map) {
    const double distance = nearest(surface, p);
    accuracy += distance;
    off5 += distance > 0.05;
    off10 += distance > 0.10;
    if (distance > 0.05 && nearest(dynamic, p) <= 0.05) ghosts.push_back(p);
  }
  const double maps = static_cast<double>(map.size());
  const double surfaces = static_cast<double>(surface.size());
  const double ghost_count = static_cast<double>(ghosts.size());
  ASSERT_GT(clusters(ghosts), 0U);  // else the test below would be weak

  const MapQuality quality = map_quality(map_cloud, {static_cloud, dynamic_cloud});
  EXPECT_EQ(quality.voxels, map.size());
  EXPECT_NEAR(quality.sa, sa / surfaces, 1e-12);
  EXPECT_NEAR(*quality.da, da / static_cast<double>(dynamic.size()), 1e-12);
  EXPECT_NEAR(*quality.accuracy_m, accuracy / maps, 1e-12);
  EXPECT_NEAR(*quality.completeness_m, completeness / surfaces, 1e-12);
  EXPECT_NEAR(*quality.off_ratio_5cm, off5 / maps, 1e-12);
  EXPECT_NEAR(*quality.off_ratio_10cm, off10 / maps, 1e-12);
  EXPECT_NEAR(*quality.ghosts->ratio, ghost_count / maps, 1e-12);
  EXPECT_NEAR(quality.ghosts->volume_l, ghost_count * 0.008, 1e-9);
  EXPECT_EQ(quality.ghosts->clusters, clusters(ghosts));
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomClouds, testing::Values(1U, 2U, 3U));

}  // namespace
}  // namespace stillmap
