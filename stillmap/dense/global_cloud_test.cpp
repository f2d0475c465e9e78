// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/global_cloud.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/geometry/se3.hpp"
#include "tests/support/brute_force_thinning.hpp"

namespace stillmap {
namespace {

CompactCloud seen_from(const Eigen::Isometry3d& T_world_keyframe, const PointCloud& world) {
  PointCloud cloud = world;
  const Eigen::Isometry3d T_keyframe_world = T_world_keyframe.inverse();
  for (Eigen::Vector3f& p : cloud.positions) {
    p = (T_keyframe_world * p.cast<double>()).cast<float>();
  }
  return compact(cloud);
}

TEST(GlobalCloud, AppliesThePose) {
  const Eigen::Isometry3d T(Eigen::Translation3d(10, 20, 30) *
                            Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  PointCloud local;
  local.positions = {{1, 2, 3}, {0.5F, 0, 0}};
  local.colors = {{1, 2, 3}, {4, 5, 6}};
  local.labels = {8, 0};
  const CompactCloud view = compact(local);
  const std::vector<PosedCloud> clouds = {{T, &view}};
  const PointCloud cloud = global_cloud(clouds, 0.01);
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_LT((cloud.positions[0] - Eigen::Vector3f(8, 21, 33)).norm(), 1e-5F);
  EXPECT_LT((cloud.positions[1] - Eigen::Vector3f(10, 20.5F, 30)).norm(), 1e-5F);
  EXPECT_EQ(cloud.colors, (std::vector<Rgb>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(cloud.labels, (std::vector<std::uint8_t>{8, 0}));
}

TEST(GlobalCloud, ViewsOfOneSurfaceFuse) {
  PointCloud world;  // one point in the middle of each voxel, so that rounding moves none out
  for (int x = -10; x < 10; ++x) {
    for (int y = -10; y < 10; ++y) {
      world.positions.emplace_back(
          (static_cast<float>(x) + 0.5F) * 0.1F, (static_cast<float>(y) + 0.5F) * 0.1F, 1.25F);
      world.colors.push_back({static_cast<std::uint8_t>(x + 10), 0, 200});
    }
  }
  const Eigen::Isometry3d T_a = make_pose(so3_exp({0.3, 0.2, -0.5}), {1, -2, 0.5});
  const Eigen::Isometry3d T_b = make_pose(so3_exp({-1.0, 2.0, 0.1}), {-3, 0.1, 4});
  const CompactCloud a = seen_from(T_a, world);
  const CompactCloud b = seen_from(T_b, world);
  const std::vector<PosedCloud> clouds = {{T_a, &a}, {T_b, &b}};
  const PointCloud fused = global_cloud(clouds, 0.1);
  ASSERT_EQ(fused.size(), world.size());
  for (std::size_t i = 0; i < fused.size(); ++i) {
    ASSERT_LT((fused.positions[i] - world.positions[i]).norm(), 4e-5F);
  }
  EXPECT_EQ(fused.colors, world.colors);
}

TEST(GlobalCloud, AgreesWithBruteForceOverSeveralClouds) {
  const std::vector<Eigen::Isometry3d> poses = {make_pose(so3_exp({0.3, 0.2, -0.5}), {1, 0, 0}),
                                                make_pose(so3_exp({1, -1, 0}), {0, 0.5, 0})};
  const std::vector<CompactCloud> local = {compact(random_cloud(20000, 1.0, 7)),
                                           compact(random_cloud(30000, 1.5, 8))};
  PointCloud all;
  std::vector<PosedCloud> clouds;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    clouds.push_back({poses[k], &local[k]});
    for (std::size_t i = 0; i < local[k].size(); ++i) {
      all.positions.push_back((poses[k] * local[k].position(i).cast<double>()).cast<float>());
      all.colors.push_back(local[k].colors[i]);
      all.labels.push_back(local[k].labels[i]);
    }
  }
  const PointCloud expected = brute_force_thinning(all, 0.2);
  const PointCloud cloud = global_cloud(clouds, 0.2);
  ASSERT_EQ(cloud.size(), expected.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_LT((cloud.positions[i] - expected.positions[i]).norm(), 1e-6F);
  }
  EXPECT_EQ(cloud.colors, expected.colors);
  EXPECT_EQ(cloud.labels, expected.labels);
  EXPECT_EQ(global_cloud(clouds, 0.2).positions, cloud.positions);
}

TEST(GlobalCloud, GivesTheSameBitsWithAnyNumberOfThreads) {
  PointCloud labelled = random_cloud(30000, 1.5, 8);
  // Labels on one side alone, so that only some of the threads meet any.
  for (std::size_t i = 0; i < labelled.size(); ++i) {
    if (labelled.positions[i].x() < 0.5F) labelled.labels[i] = 0;
  }
  std::vector<CompactCloud> local = {
      compact(random_cloud(20000, 1.0, 7)), compact(labelled), compact(random_cloud(10, 1.0, 9))};
  local[2].origin = {std::numeric_limits<float>::quiet_NaN(), 0, 0};  // lies nowhere
  const Eigen::Isometry3d T = make_pose(so3_exp({0.1, 0, 0}), {0.3, 0.2, 0.1});
  local[0].labels.clear();
  for (const double voxel_m : {0.01, 0.2, 5.0}) {
    const std::vector<PosedCloud> clouds = {
        {Eigen::Isometry3d::Identity(), &local[0]}, {T, &local[1]}, {T, &local[2]}};
    const PointCloud one = global_cloud(clouds, voxel_m);
    EXPECT_FALSE(one.empty());
    for (const std::size_t threads : {2U, 3U, 8U}) {
      const PointCloud several = global_cloud(clouds, voxel_m, threads);
      EXPECT_EQ(several.positions, one.positions) << voxel_m << " " << threads;
      EXPECT_EQ(several.colors, one.colors);
      EXPECT_EQ(several.labels, one.labels);
    }
  }
}

TEST(GlobalCloud, EmptyWithoutClouds) {
  const CompactCloud none;
  const std::vector<PosedCloud> clouds = {{Eigen::Isometry3d::Identity(), &none}};
  EXPECT_TRUE(global_cloud({}, 0.01).empty());
  EXPECT_TRUE(global_cloud(clouds, 0.01, 3).empty());
  EXPECT_TRUE(global_cloud(clouds, 0.01).empty());
}

TEST(GlobalCloud, RefusesCloudsThatAreNone) {
  CompactCloud torn = compact(random_cloud(3, 1.0, 9));
  torn.colors.pop_back();
  const std::vector<PosedCloud> clouds = {{Eigen::Isometry3d::Identity(), &torn}};
  const std::vector<PosedCloud> null = {{Eigen::Isometry3d::Identity(), nullptr}};
  EXPECT_THROW((void)global_cloud(clouds, 0.01), InternalError);
  EXPECT_THROW((void)global_cloud(null, 0.01), InternalError);
}

}  // namespace
}  // namespace stillmap
