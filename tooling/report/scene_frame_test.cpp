// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/scene_frame.hpp"

#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

// Floor, back wall and a table of a room in level axes (y down), 5 cm apart.
PointCloud room() {
  PointCloud cloud;
  for (int i = -40; i <= 40; ++i) {
    for (int k = 0; k <= 60; ++k) {
      const float x = 0.05F * static_cast<float>(i);
      const float t = 0.05F * static_cast<float>(k);
      cloud.positions.emplace_back(x, 1.2F, 1.0F + t);
      if (k < 50) cloud.positions.emplace_back(x, 1.2F - t, 4.0F);
      if (k < 20 && i > 0) cloud.positions.emplace_back(x, 0.5F, 2.0F + t);
    }
  }
  cloud.colors.resize(cloud.size(), {90, 90, 90});
  return cloud;
}

Trajectory level_camera() {
  return {StampedPose{.stamp = {0, "0"}, .T_world_camera = Eigen::Isometry3d::Identity()}};
}

TEST(SceneFrame, FindsTheFloorOfATiltedWorld) {
  const Eigen::Matrix3d R_world_level =
      Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 0, 0.3).normalized()).toRotationMatrix();
  PointCloud cloud = room();
  for (Eigen::Vector3f& p : cloud.positions) p = (R_world_level * p.cast<double>()).cast<float>();
  cloud.positions.emplace_back(0, std::numeric_limits<float>::infinity(), 0);
  cloud.colors.push_back({});
  const SceneFrame scene = scene_frame(cloud, level_camera());
  const Eigen::Vector3d down = scene.R_level_world * (R_world_level * Eigen::Vector3d::UnitY());
  EXPECT_GT(down.y(), std::cos(1.0 * std::numbers::pi / 180));
  EXPECT_NEAR(scene.R_level_world.determinant(), 1, 1e-9);
  EXPECT_NEAR((scene.R_level_world * Eigen::Vector3d::UnitZ()).x(), 0, 1e-9);  // cameras' gaze
}

TEST(SceneFrame, TakesTheDirectionThatIsGiven) {
  for (const Eigen::Vector3d& up : {Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(-1, 0, 0)}) {
    const SceneFrame scene = scene_frame(room(), {}, up);
    EXPECT_TRUE((scene.R_level_world * up.normalized()).isApprox(-Eigen::Vector3d::UnitY()));
    EXPECT_NEAR(scene.R_level_world.determinant(), 1, 1e-9);
  }
}

TEST(SceneFrame, BoxAndSpacingOfALevelRoom) {
  const SceneFrame scene = scene_frame(room(), level_camera());
  EXPECT_LT((scene.box.min() - Eigen::Vector3d(-2, -1.25, 1)).norm(), 0.2);
  EXPECT_LT((scene.box.max() - Eigen::Vector3d(2, 1.2, 4)).norm(), 0.2);
  EXPECT_GT(scene.spacing_m, 0.03);
  EXPECT_LT(scene.spacing_m, 0.07);
}

TEST(SceneFrame, StraysDoNotCount) {
  PointCloud cloud = room();
  const std::size_t count = cloud.size();
  cloud.positions.emplace_back(1e6F, 0, 0);
  cloud.positions.emplace_back(0, std::numeric_limits<float>::quiet_NaN(), 0);
  cloud.colors.resize(cloud.size());
  const SceneFrame scene = scene_frame(cloud, level_camera());
  EXPECT_LT(scene.box.sizes().maxCoeff(), 6);
  EXPECT_EQ(points_in_scene(cloud, scene).size(), count);
}

TEST(SceneFrame, ViewsShowTheRoom) {
  const PointCloud cloud = room();
  const SceneFrame scene = scene_frame(cloud, level_camera());
  const View above = view_from_above(scene, 300, 200);
  int seen = 0;
  for (const Eigen::Vector3f& p : cloud.positions) {
    const std::optional<Eigen::Vector3d> px = project_point(above, p.cast<double>());
    if (p.y() < -0.5F) {
      EXPECT_FALSE(px.has_value());  // over the camera's head
    } else if (px && px->x() >= 0 && px->x() < 300 && px->y() >= 0 && px->y() < 200) {
      ++seen;
    }
  }
  EXPECT_GT(seen, 4000);
  // Points farther ahead are higher in the picture, points on the right are right.
  const Eigen::Vector3d near_left = project_point(above, {-1, 1, 2}).value();
  const Eigen::Vector3d far_right = project_point(above, {1, 1, 3}).value();
  EXPECT_LT(near_left.x(), far_right.x());
  EXPECT_GT(near_left.y(), far_right.y());

  const View along = view_along(scene, 300, 200);
  const Eigen::Vector3d center =
      project_point(along, scene.box.merged(scene.cameras).center()).value();
  EXPECT_NEAR(center.x(), 150, 2);
  EXPECT_NEAR(center.y(), 100, 2);
  EXPECT_LT(project_point(along, {-1, 1.2, 2})->x(), project_point(along, {1, 1.2, 2})->x());
  EXPECT_LT(project_point(along, {0, -1, 3})->y(), project_point(along, {0, 1, 3})->y());
}

TEST(SceneFrame, OfNothingOrOnePointStillGivesViews) {
  PointCloud cloud;
  const SceneFrame nothing = scene_frame(cloud, {});
  EXPECT_TRUE(nothing.box.isEmpty());
  EXPECT_TRUE(points_in_scene(cloud, nothing).empty());
  EXPECT_TRUE(view_along(nothing, 30, 20).T_camera_world.matrix().allFinite());
  EXPECT_TRUE(view_from_above(nothing, 30, 20).T_camera_world.matrix().allFinite());
  cloud.positions = {{1, 2, 3}};
  cloud.colors.resize(1);
  const SceneFrame one = scene_frame(cloud, {});
  EXPECT_EQ(points_in_scene(cloud, one).size(), 1U);
  EXPECT_TRUE(project_point(view_along(one, 30, 20), {1, 2, 3}).has_value());
}

}  // namespace
}  // namespace stillmap
