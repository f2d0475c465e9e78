// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/camera.hpp"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

TEST(Camera, DistortEqualsOpenCv) {
  for (const std::string& name : builtin_camera_names()) {
    const CameraModel camera = builtin_camera(name);
    const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    const cv::Vec<double, 5> D(camera.k1, camera.k2, camera.p1, camera.p2, camera.k3);
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> u(-0.5, 0.5);
    for (int i = 0; i < 100; ++i) {
      const cv::Point3d point(u(rng), u(rng), 1.0);
      std::vector<cv::Point2d> expected;
      cv::projectPoints(std::vector{point}, cv::Vec3d(), cv::Vec3d(), K, D, expected);
      const Eigen::Vector2d actual = camera.distort(camera.project({point.x, point.y, point.z}));
      EXPECT_NEAR(actual.x(), expected[0].x, 1e-9) << name;
      EXPECT_NEAR(actual.y(), expected[0].y, 1e-9) << name;
    }
  }
}

TEST(Camera, UndistortInvertsDistortOverTheWholeImage) {
  for (const std::string& name : builtin_camera_names()) {
    const CameraModel camera = builtin_camera(name);
    for (int v = 0; v < camera.height_px; v += 16) {
      for (int u = 0; u < camera.width_px; u += 16) {
        const Eigen::Vector2d raw(u, v);
        EXPECT_LT((camera.distort(camera.undistort(raw)) - raw).norm(), 1e-9) << name;
      }
    }
  }
}

TEST(Camera, UnprojectInvertsProject) {
  const CameraModel camera = builtin_camera("tum_fr3");
  const Eigen::Vector3d p(0.3, -0.2, 2.5);
  EXPECT_LT((camera.unproject(camera.project(p), 2.5) - p).norm(), 1e-12);
}

TEST(Camera, RaysAreThoseOfUndistortedPixels) {
  const CameraModel camera = builtin_camera("tum_fr1");
  const cv::Mat2f rays = pixel_rays(camera);
  const Eigen::Vector2d ideal = camera.undistort({600, 30});
  EXPECT_NEAR(rays(30, 600)[0], (ideal.x() - camera.cx) / camera.fx, 1e-6);
  EXPECT_NEAR(rays(30, 600)[1], (ideal.y() - camera.cy) / camera.fy, 1e-6);
}

TEST(Camera, UnknownNameSuggestsTheNearest) {
  try {
    (void)builtin_camera("tum_f1");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'tum_fr1'?"));
  }
}

}  // namespace
}  // namespace stillmap
