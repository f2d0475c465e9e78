// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/depth_jump.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

CameraModel small_camera(bool distorted) {
  CameraModel camera = builtin_camera(distorted ? "tum_fr1" : "tum_fr3");
  camera.width_px = 320;
  camera.height_px = 240;
  camera.fx /= 2, camera.fy /= 2, camera.cx /= 2, camera.cy /= 2;
  return camera;
}

CameraModel small_fisheye() {
  CameraModel camera = small_camera(false);
  camera.name = "fisheye";
  camera.fx *= 0.7;
  camera.fy *= 0.7;
  camera.lens = LensModel::kFisheye;
  camera.k1 = 0.02;
  camera.k2 = -0.01;
  return camera;
}

/// Two walls one behind the other, seen from a camera: the near one, at z = 2 m in the world,
/// reaches from x = -0.5 m to x = 0.3 m and is 1 m high; the far one, at 4 m, is infinite.
/// Optionally a third at 2 m, from x = 0.3 m on and 0.1 m wide.
DepthImage see(const CameraModel& camera, const Eigen::Isometry3d& T_world_camera, bool third) {
  const cv::Mat2f rays = pixel_rays(camera);
  DepthImage depth(cv::Mat1f(rays.size()));
  for (int v = 0; v < rays.rows; ++v) {
    for (int u = 0; u < rays.cols; ++u) {
      const Eigen::Vector3d ray =
          T_world_camera.linear() * Eigen::Vector3d(static_cast<double>(rays(v, u)[0]),
                                                    static_cast<double>(rays(v, u)[1]),
                                                    1);
      const Eigen::Vector3d from = T_world_camera.translation();
      const double near = (2.0 - from.z()) / ray.z();
      const Eigen::Vector3d hit = from + near * ray;
      const bool on_near =
          hit.x() > -0.5 && hit.x() < (third ? 0.4 : 0.3) && std::abs(hit.y()) < 0.5;
      depth.mat(v, u) = static_cast<float>(on_near ? near : (4.0 - from.z()) / ray.z());
    }
  }
  return depth;
}

Eigen::Isometry3d moved() {
  return make_pose(so3_exp({0.02, -0.03, 0.015}), {0.05, -0.02, 0.04});
}

int count(const cv::Mat1b& jumps, DepthJump kind) {
  return cv::countNonZero(jumps == kind);
}

TEST(DepthJumps, OfEquation6ByHand) {
  const DepthImage before(
      cv::Mat1f((cv::Mat_<float>(1, 7) << 2.0F, 2.0F, 2.0F, 0.0F, 2.0F, 3.5F, 0.0F)));
  const DepthImage now(
      cv::Mat1f((cv::Mat_<float>(1, 7) << 2.9F, 3.1F, 0.9F, 5.0F, 0.0F, 3.5F, 0.9F)));
  const cv::Mat1b jumps = depth_jumps(now, before, 1.0).mat;
  EXPECT_EQ(jumps(0, 0), kNoJump);
  EXPECT_EQ(jumps(0, 1), kWentFarther);
  EXPECT_EQ(jumps(0, 2), kCameNearer);
  EXPECT_EQ(jumps(0, 3), kWentFarther);  // missing before is depth 0
  EXPECT_EQ(jumps(0, 4), kNoJump);       // missing now
  EXPECT_EQ(jumps(0, 5), kNoJump);
  EXPECT_EQ(jumps(0, 6), kNoJump);  // missing before, but nearer than the jump
}

TEST(DepthWarper, PutsPointsWhereTheCameraSeesThem) {
  for (const CameraModel& camera : {small_camera(false), small_camera(true), small_fisheye()}) {
    const Eigen::Isometry3d T_world_current = moved();
    const DepthImage before = see(camera, Eigen::Isometry3d::Identity(), false);
    const DepthImage now = see(camera, T_world_current, false);
    const HalfDepth warped = DepthWarper(camera).warp(before, T_world_current.inverse());
    ASSERT_EQ(warped.mat.size(), cv::Size(160, 120));
    int known = 0, close = 0;
    for (int v = 0; v < 120; ++v) {
      for (int u = 0; u < 160; ++u) {
        if (warped.mat(v, u) == 0) continue;
        ++known;
        // A cell's point may be off by half a cell, which on these walls changes depth little.
        close += std::abs(warped.mat(v, u) - now.mat(2 * v, 2 * u)) < 0.01F ? 1 : 0;
      }
    }
    EXPECT_GT(known, 0.85 * 160 * 120) << camera.name;
    EXPECT_GT(close, 0.97 * known) << camera.name;
  }
}

TEST(DepthWarper, TheNearestOfSeveralPointsWins) {
  const CameraModel camera = small_camera(false);
  DepthImage before(cv::Mat1f(240, 320, 4.0F));
  before.mat(cv::Rect(150, 110, 20, 20)).setTo(1.0F);
  // From 0.5 m to the right, the near square is 67 pixels farther left.
  const Eigen::Isometry3d T = make_pose(Eigen::Quaterniond::Identity(), {-0.5, 0, 0});
  const HalfDepth warped = DepthWarper(camera).warp(before, T);
  const int shift = static_cast<int>(std::lround(camera.fx * 0.5 / 1.0));
  EXPECT_EQ(warped.mat(60, (160 - shift) / 2), 1.0F);
}

TEST(DepthJumps, AStaticSceneHasNoneWhereTheMotionIsKnown) {
  for (const CameraModel& camera : {small_camera(false), small_camera(true), small_fisheye()}) {
    const DepthImage before = see(camera, Eigen::Isometry3d::Identity(), false);
    const DepthImage now = see(camera, moved(), false);
    DepthJumpConfig config;
    config.revealed = true;
    const HalfDepth warped = DepthWarper(camera).warp(before, moved().inverse());
    const cv::Mat1b jumps = depth_jumps(now, warped, config).mat;
    EXPECT_EQ(cv::countNonZero(jumps), 0);
    EXPECT_GT(cv::countNonZero(depth_jumps(now, before, 1.0).mat), 500);  // without the warp
  }
}

TEST(DepthJumps, WhatCameIntoTheSceneIsFound) {
  const CameraModel camera = small_camera(false);
  const DepthImage before = see(camera, Eigen::Isometry3d::Identity(), false);
  const DepthImage now = see(camera, moved(), true);
  const HalfDepth warped = DepthWarper(camera).warp(before, moved().inverse());
  const cv::Mat1b jumps = depth_jumps(now, warped, {}).mat;
  const cv::Mat1b truth = see(camera, moved(), false).mat - now.mat > 1.0F;
  EXPECT_GT(cv::countNonZero(truth), 500);
  EXPECT_GT(cv::countNonZero(truth & (jumps == kCameNearer)), 0.6 * cv::countNonZero(truth));
  EXPECT_EQ(cv::countNonZero(~truth & jumps), 0);
}

TEST(DepthJumps, WhatWentAwayOnlyWhenAsked) {
  const CameraModel camera = small_camera(false);
  const DepthImage before = see(camera, Eigen::Isometry3d::Identity(), true);
  const DepthImage now = see(camera, moved(), false);
  const HalfDepth warped = DepthWarper(camera).warp(before, moved().inverse());
  DepthJumpConfig config;
  EXPECT_EQ(cv::countNonZero(depth_jumps(now, warped, config).mat), 0);
  config.revealed = true;
  EXPECT_GT(count(depth_jumps(now, warped, config).mat, kWentFarther), 300);
}

TEST(DepthJumps, MissingDepthIsNone) {
  const CameraModel camera = small_camera(false);
  const DepthImage wall(cv::Mat1f(240, 320, 3.0F)), nothing(cv::Mat1f(240, 320, 0.0F));
  DepthJumpConfig config;
  config.revealed = true;
  const DepthWarper warper(camera);
  const Eigen::Isometry3d still = Eigen::Isometry3d::Identity();
  EXPECT_EQ(cv::countNonZero(depth_jumps(wall, warper.warp(nothing, still), config).mat), 0);
  EXPECT_EQ(cv::countNonZero(depth_jumps(nothing, warper.warp(wall, still), config).mat), 0);
}

}  // namespace
}  // namespace stillmap
