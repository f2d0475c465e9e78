// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/camera.hpp"

#include <cmath>
#include <numbers>
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

// Lenses with more than the five parameters of Brown-Conrady.
CameraModel rational_camera() {  // of the kind of Azure Kinect's wide depth camera: 120 degrees
  CameraModel c{"rational", 512, 512, 252.2, 252.3, 259.6, 258.1};
  c.k1 = 5.83, c.k2 = 3.22, c.p1 = -8.1e-5, c.p2 = 4.2e-5, c.k3 = 0.121;
  c.k4 = 6.16, c.k5 = 4.95, c.k6 = 0.83;
  return c;
}

CameraModel fisheye_camera() {  // of the kind of TUM VI's: beyond 180 degrees in the corners
  CameraModel c{"fisheye", 512, 512, 190.98, 190.97, 254.93, 256.90};
  c.lens = LensModel::kFisheye;
  c.k1 = 0.0034824, c.k2 = 0.00071503, c.k3 = -0.0020533, c.k4 = 0.00020294;
  return c;
}

cv::Matx33d matrix_of(const CameraModel& c) {
  return {c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1};
}

Eigen::Vector2d ideal_at(const CameraModel& c, double slope, double turn) {
  return c.project({slope * std::cos(turn), slope * std::sin(turn), 1.0});
}

TEST(Camera, RationalDistortionEqualsOpenCv) {
  const CameraModel c = rational_camera();
  const cv::Vec<double, 8> D(c.k1, c.k2, c.p1, c.p2, c.k3, c.k4, c.k5, c.k6);
  for (int i = 0; i < 200; ++i) {
    const double slope = 0.01 * i, turn = 0.7 * i;
    const cv::Point3d point(slope * std::cos(turn), slope * std::sin(turn), 1);
    std::vector<cv::Point2d> expected;
    cv::projectPoints(std::vector{point}, cv::Vec3d(), cv::Vec3d(), matrix_of(c), D, expected);
    const Eigen::Vector2d actual = c.distort(ideal_at(c, slope, turn));
    EXPECT_NEAR(actual.x(), expected[0].x, 1e-9) << slope;
    EXPECT_NEAR(actual.y(), expected[0].y, 1e-9) << slope;
  }
}

TEST(Camera, FisheyeEqualsOpenCv) {
  const CameraModel c = fisheye_camera();
  const cv::Vec4d D(c.k1, c.k2, c.k3, c.k4);
  for (int i = 0; i < 89; ++i) {
    const double slope = std::tan(i * std::numbers::pi / 180), turn = 0.7 * i;
    const cv::Point3d point(slope * std::cos(turn), slope * std::sin(turn), 1);
    std::vector<cv::Point2d> expected;
    cv::fisheye::projectPoints(
        std::vector{point}, expected, cv::Vec3d(), cv::Vec3d(), matrix_of(c), D);
    const Eigen::Vector2d actual = c.distort(ideal_at(c, slope, turn));
    EXPECT_NEAR(actual.x(), expected[0].x, 1e-9) << i;
    EXPECT_NEAR(actual.y(), expected[0].y, 1e-9) << i;
  }
}

TEST(Camera, WideLensesAreInvertedOverTheWholeImage) {
  int without_ray = 0;
  for (const CameraModel& c : {rational_camera(), fisheye_camera()}) {
    for (int v = -16; v < c.height_px + 16; v += 8) {
      for (int u = -16; u < c.width_px + 16; u += 8) {
        const Eigen::Vector2d raw(u, v);
        const Eigen::Vector2d ideal = c.undistort(raw);
        ASSERT_TRUE(ideal.allFinite());
        if (c.has_ray(ideal)) {
          EXPECT_LT((c.distort(ideal) - raw).norm(), 1e-9) << c.name << ' ' << u << ' ' << v;
        } else {
          // Of the fish-eye, only what is 90 degrees or more off its axis has no ray.
          EXPECT_EQ(c.name, "fisheye");
          const double distance = std::hypot((u - c.cx) / c.fx, (v - c.cy) / c.fy);
          const double a2 = std::numbers::pi * std::numbers::pi / 4;
          const double at_90_deg =
              std::numbers::pi / 2 * (1 + a2 * (c.k1 + a2 * (c.k2 + a2 * (c.k3 + a2 * c.k4))));
          EXPECT_GT(distance, at_90_deg - 1e-3);
          ++without_ray;
        }
      }
    }
  }
  EXPECT_GT(without_ray, 0);
}

// Bisection along the radius, with nothing but distort().
double slope_by_bisection(const CameraModel& c, double radius_px, double greatest) {
  double low = 0, high = greatest;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    const double reached = (c.distort(ideal_at(c, middle, 0)) - Eigen::Vector2d(c.cx, c.cy)).norm();
    (reached < radius_px ? low : high) = middle;
  }
  return low;
}

TEST(Camera, UndistortEqualsANumericInverse) {
  CameraModel rational = rational_camera();
  rational.p1 = rational.p2 = 0;  // radial only, so that the radius alone decides
  for (const CameraModel& c : {rational, fisheye_camera()}) {
    for (double radius = 5; radius < 250; radius += 5) {
      const double slope = c.unproject(c.undistort({c.cx + radius, c.cy}), 1).x();
      EXPECT_NEAR(slope, slope_by_bisection(c, radius, 100), 1e-10 * (1 + slope * slope))
          << c.name << ' ' << radius;
    }
  }
}

TEST(Camera, NoRayLeadsBeyondAFold) {
  for (const LensModel lens : {LensModel::kBrownConrady, LensModel::kFisheye}) {
    CameraModel c{"fold", 640, 480, 300, 300, 320, 240};
    c.lens = lens;
    c.k1 = -0.3;
    // r (1 - 0.3 r^2) has its greatest value, 2 / 3 / sqrt(0.9), at r = 1 / sqrt(0.9).
    const double fold_px = 300 * 2.0 / 3 / std::sqrt(0.9);
    EXPECT_TRUE(c.has_ray(c.undistort({320 + 0.99 * fold_px, 240})));
    EXPECT_FALSE(c.has_ray(c.undistort({320 + 1.01 * fold_px, 240})));
    EXPECT_FALSE(c.has_ray(c.undistort({320, 240 - 1.5 * fold_px})));
    const double slope = c.unproject(c.undistort({320 + 0.99 * fold_px, 240}), 1).x();
    EXPECT_LT(lens == LensModel::kFisheye ? std::atan(slope) : slope, 1 / std::sqrt(0.9));
  }
}

TEST(Camera, SameLensComparesEveryNumber) {
  const CameraModel c = rational_camera();
  EXPECT_TRUE(same_lens(c, rational_camera()));
  for (double CameraModel::*number : {&CameraModel::fx,
                                      &CameraModel::fy,
                                      &CameraModel::cx,
                                      &CameraModel::cy,
                                      &CameraModel::k1,
                                      &CameraModel::k2,
                                      &CameraModel::p1,
                                      &CameraModel::p2,
                                      &CameraModel::k3,
                                      &CameraModel::k4,
                                      &CameraModel::k5,
                                      &CameraModel::k6}) {
    CameraModel other = c;
    other.*number += 1e-6;
    EXPECT_FALSE(same_lens(c, other));
  }
  CameraModel other = c;
  other.lens = LensModel::kFisheye;
  EXPECT_FALSE(same_lens(c, other));
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
