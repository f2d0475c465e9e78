// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/multi_view.hpp"

#include <array>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

const cv::Rect kStandingBox(200, 120, 120, 240);  // in the image, where something stands now

/// A wall at 3 m before a camera that has moved since, and points that were seen on it.
struct Wall {
  CameraModel camera = builtin_camera("tum_fr3");
  Eigen::Isometry3d T_current_view = make_pose(so3_exp({0.0, 0.02, 0.0}), {0.1, 0.0, 0.0});
  DepthImage depth{cv::Mat1f(480, 640, 3.0F)};
  std::vector<Eigen::Vector3d> points;

  Wall() {
    for (int v = 20; v < 480; v += 20) {
      for (int u = 20; u < 640; u += 20) {
        points.push_back(T_current_view.inverse() * camera.unproject({u, v}, 3.0));
      }
    }
  }
  [[nodiscard]] cv::Mat1b hiding() const {
    const std::array views{PointView{points, T_current_view}};
    return hiding_objects(depth, views, camera, {}).mat;
  }
};

TEST(HidingObjects, AreWholeAndNothingElseIs) {
  Wall wall;
  EXPECT_EQ(cv::countNonZero(wall.hiding()), 0);
  wall.depth.mat(kStandingBox).setTo(1.5F);
  const cv::Mat1b hiding = wall.hiding();
  EXPECT_EQ(cv::countNonZero(hiding), kStandingBox.area());
  EXPECT_EQ(cv::countNonZero(hiding(kStandingBox) == kCameNearer), kStandingBox.area());
}

// 0.4 m: the depth of the box is 2.65 m, then 2.55 m.
TEST(HidingObjects, AreNearerThanTheBound) {
  Wall wall;
  wall.depth.mat(kStandingBox).setTo(2.65F);
  EXPECT_EQ(cv::countNonZero(wall.hiding()), 0);
  wall.depth.mat(kStandingBox).setTo(2.55F);
  EXPECT_EQ(cv::countNonZero(wall.hiding()), kStandingBox.area());
}

// From 3 m aside, the rays to the wall differ by 45 degrees: what hides it may stand there still.
TEST(HidingObjects, AreNotJudgedAcrossAWideParallax) {
  Wall wall;
  wall.depth.mat(kStandingBox).setTo(1.5F);
  const Eigen::Isometry3d T_view_before = wall.T_current_view;
  wall.T_current_view = make_pose(so3_exp({0.0, 0.0, 0.0}), {3.0, 0.0, 0.0});
  for (Eigen::Vector3d& p : wall.points) p = wall.T_current_view.inverse() * (T_view_before * p);
  EXPECT_EQ(cv::countNonZero(wall.hiding()), 0);
}

// A pole of two pixels has no 3 x 3 pixels of like depth: points beside it are hidden by its rim.
TEST(HidingObjects, AreNotFoundByTheirRimsAlone) {
  Wall wall;
  wall.depth.mat(cv::Rect(199, 0, 2, 480)).setTo(1.5F);
  EXPECT_EQ(cv::countNonZero(wall.hiding()), 0);
}

TEST(HidingObjects, NothingIsKnownWhereDepthIsMissing) {
  Wall wall;
  wall.depth.mat(kStandingBox).setTo(0.0F);
  EXPECT_EQ(cv::countNonZero(wall.hiding()), 0);
}

}  // namespace
}  // namespace stillmap
