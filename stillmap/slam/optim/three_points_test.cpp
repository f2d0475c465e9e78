// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/three_points.hpp"

#include <gtest/gtest.h>

namespace stillmap {
namespace {

const PointTriple kTriangle = {
    Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.5, 0, 1), Eigen::Vector3d(0, 0.4, 1)};

PointTriple moved(const PointTriple& triangle, const Eigen::Isometry3d& motion) {
  return {motion * triangle[0], motion * triangle[1], motion * triangle[2]};
}

TEST(SameShape, OfAMovedTriangle) {
  const Eigen::Isometry3d motion =
      Eigen::Translation3d(0.3, -0.2, 0.1) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY());
  EXPECT_TRUE(same_shape(kTriangle, moved(kTriangle, motion)));
}

TEST(SameShape, NotWhereASideIsLonger) {
  PointTriple other = kTriangle;
  other[1].x() = 0.54;  // of 0.5 m at 1 m: 0.045 m are allowed
  EXPECT_TRUE(same_shape(kTriangle, other));
  other[1].x() = 0.55;
  EXPECT_FALSE(same_shape(kTriangle, other));
  // At 3 m depth is known less well: 0.205 m are allowed.
  const Eigen::Isometry3d away(Eigen::Translation3d(0, 0, 2));
  EXPECT_TRUE(same_shape(moved(kTriangle, away), moved(other, away)));
}

TEST(SameShape, NotOfPointsThatAreNextToEachOther) {
  PointTriple narrow = kTriangle;
  narrow[2] = Eigen::Vector3d(0, 0.09, 1);
  EXPECT_FALSE(same_shape(narrow, narrow));
}

TEST(NearMeasurement, AllowsTwiceTheErrorOfATruePoint) {
  CameraModel camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx = camera.fy = 500;
  camera.cx = 320;
  camera.cy = 240;
  PointMeasurement m;
  m.px = Eigen::Vector2d(320, 240);
  m.pixel_weight = 1;
  // Two degrees of freedom: 95 % of true points are within sqrt(5.99) = 2.45 px.
  EXPECT_TRUE(near_measurement(camera, m, Eigen::Vector3d(4.8 / 500, 0, 1)));
  EXPECT_FALSE(near_measurement(camera, m, Eigen::Vector3d(5.0 / 500, 0, 1)));
  EXPECT_FALSE(near_measurement(camera, m, Eigen::Vector3d(0, 0, -1)));
}

}  // namespace
}  // namespace stillmap
