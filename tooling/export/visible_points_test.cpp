// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/visible_points.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "tests/support/room.hpp"

namespace stillmap {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const Eigen::Isometry3d kHere = Eigen::Isometry3d::Identity();
const VisibilityOptions kOptions = {.point_radius_m = 0.01, .margin_m = 0.1};

TEST(VisiblePoints, AreThoseBeforeTheCameraAndInTheImage) {
  // The image spans x/z from -160/260 to 159/260.
  const std::vector<Eigen::Vector3f> points = {
      {0, 0, 1}, {0, 0, -1}, {0, 0, 0.01F}, {0.61F, 0, 1}, {0.62F, 0, 1}, {-0.61F, 0, 1}};
  EXPECT_THAT(visible_points(points, kHere, test_camera(), kOptions), ElementsAre(0, 3, 5));
  EXPECT_THAT(visible_points({}, kHere, test_camera(), kOptions), IsEmpty());
}

TEST(VisiblePoints, FollowThePose) {
  const std::vector<Eigen::Vector3f> points = {{2, 0, 1}, {-1, 0, 1}};
  EXPECT_THAT(visible_points(points, looking({0, 0, 1}, 0, 0), test_camera(), kOptions),
              ElementsAre(0));
}

TEST(VisiblePoints, HideWhatIsBehindThem) {
  // A disc of 1 cm at 1 m covers 2.6 pixels round the centre; at 2 m, 10 pixels are 7.7 cm.
  const std::vector<Eigen::Vector3f> points = {
      {0, 0, 1}, {0, 0, 2}, {0, 0, 1.05F}, {0.1F, 0, 2}, {-0.1F, 0.1F, 2}};
  EXPECT_THAT(visible_points(points, kHere, test_camera(), kOptions), ElementsAre(0, 2, 3, 4));
}

TEST(VisiblePoints, OfASurfaceWithGapsBelowTheirSizeLetNothingThrough) {
  PointCloud wall;
  add_rectangle(wall, {-1, -1, 0.4}, {2, 0, 0}, {0, 2, 0});  // 6.5 pixels between points
  const std::size_t front = wall.size();
  add_rectangle(wall, {-1, -1, 1.5}, {2, 0, 0}, {0, 2, 0});
  for (const std::uint32_t i : visible_points(wall.positions, kHere, test_camera(), kOptions)) {
    ASSERT_LT(i, front);
  }
}

TEST(VisiblePoints, OfADistortedCameraLieInsideItsImage) {
  CameraModel camera = builtin_camera("tum_fr1");
  PointCloud wall;
  add_rectangle(wall, {-2, -2, 2}, {4, 0, 0}, {0, 4, 0});
  const std::vector<std::uint32_t> seen = visible_points(wall.positions, kHere, camera, kOptions);
  double right = 0;
  for (const std::uint32_t i : seen) {
    const Eigen::Vector2d raw = camera.distort(camera.project(wall.positions[i].cast<double>()));
    ASSERT_TRUE(raw.x() >= -0.5 && raw.x() <= 639.5 && raw.y() >= -0.5 && raw.y() <= 479.5);
    right = std::max(right, raw.x());
  }
  EXPECT_GT(right, 620);
}

TEST(VisiblePoints, OfACameraWithAWildDistortionAreFewOrAnError) {
  const std::vector<Eigen::Vector3f> points = {{0, 0, 1}, {0.3F, 0, 1}};
  for (const double k1 : {-1e9, -5.0, 1e3, 1e9}) {
    CameraModel camera = test_camera();
    camera.k1 = k1;
    try {
      EXPECT_LE(visible_points(points, kHere, camera, kOptions).size(), 2U);
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("camera test"));
    }
  }
}

}  // namespace
}  // namespace stillmap
