// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/depth_registration.hpp"

#include <cmath>
#include <cstdint>
#include <memory>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace stillmap {
namespace {

// A ball in front of a slanted wall, in the color camera's frame: their depths are known in closed
// form for any ray.
constexpr double kBallRadiusM = 0.25;
const Eigen::Vector3d kBall(0.05, -0.05, 1.2);
const Eigen::Vector3d kWallNormal = Eigen::Vector3d(0.5, 0.2, -1).normalized();
const Eigen::Vector3d kWallPoint(0, 0, 2.5);

struct Hit {
  Eigen::Vector3d p;  // in the color camera's frame
  bool ball = false;
};

Hit trace(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d d = direction.normalized(), to_ball = kBall - origin;
  const double along = to_ball.dot(d);
  const double miss2 = to_ball.squaredNorm() - along * along;
  if (miss2 < kBallRadiusM * kBallRadiusM && along > 0) {
    return {origin + (along - std::sqrt(kBallRadiusM * kBallRadiusM - miss2)) * d, true};
  }
  return {origin + (kWallPoint - origin).dot(kWallNormal) / d.dot(kWallNormal) * d, false};
}

CameraModel camera_of(int width, int height, double f) {
  CameraModel c{"test", width, height, f, f, 0.5 * width - 0.5, 0.5 * height - 0.5};
  return c;
}

Eigen::Vector3d ray_of(const CameraModel& c, int x, int y) {
  return c.unproject(c.undistort(Eigen::Vector2d(x, y)), 1.0);
}

// What a camera at T sees of the scene.
DepthImage seen_from(const CameraModel& c, const Eigen::Isometry3d& T_color_camera) {
  cv::Mat1f depth(c.height_px, c.width_px);
  for (int y = 0; y < c.height_px; ++y) {
    for (int x = 0; x < c.width_px; ++x) {
      const Eigen::Vector3d direction = T_color_camera.linear() * ray_of(c, x, y);
      const Hit hit = trace(T_color_camera.translation(), direction);
      depth(y, x) = static_cast<float>((T_color_camera.inverse() * hit.p).z());
    }
  }
  return DepthImage(depth);
}

Eigen::Isometry3d beside() {
  return Eigen::Translation3d(-0.06, 0.01, 0.005) *
         Eigen::AngleAxisd(0.02, Eigen::Vector3d(0.3, 1, 0.2).normalized());
}

CameraModel with_depth_camera(CameraModel color,
                              const CameraModel& depth,
                              const Eigen::Isometry3d& T_color_depth) {
  color.depth_camera = std::make_shared<DepthCamera>(DepthCamera{depth, T_color_depth});
  return color;
}

enum Kind : std::uint8_t { kOutside, kWall, kBallSurface, kHidden };

// What the depth camera can know of each color pixel: outside its image, hidden from it by the
// ball, or a surface that both see.
cv::Mat1b kinds_of(const CameraModel& color) {
  const DepthCamera& depth = *color.depth_camera;
  const Eigen::Vector3d origin = depth.T_color_depth.translation();
  cv::Mat1b kinds(color.height_px, color.width_px);
  for (int y = 0; y < kinds.rows; ++y) {
    for (int x = 0; x < kinds.cols; ++x) {
      const Hit hit = trace(Eigen::Vector3d::Zero(), ray_of(color, x, y));
      const Eigen::Vector2d px =
          depth.camera.distort(depth.camera.project(depth.T_color_depth.inverse() * hit.p));
      const bool inside = px.x() >= 0 && px.y() >= 0 && px.x() <= depth.camera.width_px - 1 &&
                          px.y() <= depth.camera.height_px - 1;
      const bool seen = (trace(origin, hit.p - origin).p - hit.p).norm() < 1e-6;
      kinds(y, x) = !inside ? kOutside : !seen ? kHidden : hit.ball ? kBallSurface : kWall;
    }
  }
  return kinds;
}

// Whether all pixels around are of one kind.
bool is_clear(const cv::Mat1b& kinds, int x, int y, int reach_px) {
  for (int row = y - reach_px; row <= y + reach_px; ++row) {
    for (int column = x - reach_px; column <= x + reach_px; ++column) {
      if (row < 0 || column < 0 || row >= kinds.rows || column >= kinds.cols) continue;
      if (kinds(row, column) != kinds(y, x)) return false;
    }
  }
  return true;
}

struct Comparison {
  int compared = 0;       // pixels that both cameras see, off all rims
  int holes = 0;          // of them, without depth
  double greatest_m = 0;  // error of the others
  double mean_m = 0;
  int hidden = 0;        // pixels of the wall that the ball hides from the depth camera
  int hidden_known = 0;  // of them, with depth
};

Comparison compare(const CameraModel& color, const DepthImage& registered, int reach_px) {
  const cv::Mat1b kinds = kinds_of(color);
  Comparison result;
  for (int y = 0; y < kinds.rows; ++y) {
    for (int x = 0; x < kinds.cols; ++x) {
      if (kinds(y, x) == kOutside || !is_clear(kinds, x, y, reach_px)) continue;
      const float z = registered.mat(y, x);
      if (kinds(y, x) == kHidden) {
        ++result.hidden;
        result.hidden_known += z > 0 ? 1 : 0;
        continue;
      }
      ++result.compared;
      if (!(z > 0)) {
        ++result.holes;
        continue;
      }
      const double truth = trace(Eigen::Vector3d::Zero(), ray_of(color, x, y)).p.z();
      const double error = std::abs(z - truth);
      result.greatest_m = std::max(result.greatest_m, error);
      result.mean_m += error;
    }
  }
  result.mean_m /= result.compared - result.holes;
  return result;
}

TEST(DepthRegistration, OfTheSameCameraIsTheIdentity) {
  const CameraModel c = camera_of(160, 120, 140);
  const CameraModel color = with_depth_camera(c, c, Eigen::Isometry3d::Identity());
  cv::Mat1f depth = seen_from(c, Eigen::Isometry3d::Identity()).mat;
  depth(50, 60) = 0;
  const cv::Mat1f out = DepthRegistration(color).to_color(DepthImage(depth)).mat;
  int changed = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) changed += std::abs(out(y, x) - depth(y, x)) > 1e-5F ? 1 : 0;
  }
  EXPECT_EQ(changed, 0);
  EXPECT_EQ(out(50, 60), 0.0F);
}

TEST(DepthRegistration, AgreesWithTheTruthForDepthOfAnotherSizeAndView) {
  CameraModel distorted = camera_of(320, 240, 260);
  distorted.k1 = 0.1;
  distorted.k2 = -0.2;
  CameraModel fisheye = camera_of(200, 150, 150);
  fisheye.lens = LensModel::kFisheye;
  fisheye.k1 = 0.01;
  for (const CameraModel& depth : {camera_of(160, 120, 130), camera_of(640, 480, 520), fisheye}) {
    const CameraModel color = with_depth_camera(distorted, depth, beside());
    const DepthImage raw = seen_from(depth, beside());
    const Comparison done = compare(color, DepthRegistration(color).to_color(raw), 4);
    EXPECT_GT(done.compared, 55000);
    EXPECT_EQ(done.holes, 0) << depth.width_px;
    EXPECT_LT(done.mean_m, 0.001) << depth.width_px;
    EXPECT_LT(done.greatest_m, 0.02) << depth.width_px;
    EXPECT_GE(done.hidden, 5) << depth.width_px;
    EXPECT_EQ(done.hidden_known, 0) << depth.width_px;
  }
}

TEST(DepthRegistration, IsNeededWhereTheViewsDiffer) {
  const CameraModel c = camera_of(320, 240, 260);
  const CameraModel color = with_depth_camera(c, c, beside());
  const DepthImage raw = seen_from(c, beside());
  EXPECT_GT(compare(color, raw, 4).mean_m, 0.01);
  EXPECT_LT(compare(color, DepthRegistration(color).to_color(raw), 4).mean_m, 0.001);
}

// The color image is five times as fine: the wall must not show between the ball's pixels.
TEST(DepthRegistration, KeepsTheNearestWhereSurfacesOverlap) {
  const CameraModel depth = camera_of(160, 120, 100), c = camera_of(640, 480, 520);
  const CameraModel color = with_depth_camera(c, depth, beside());
  const cv::Mat1f out = DepthRegistration(color).to_color(seen_from(depth, beside())).mat;
  const cv::Mat1b kinds = kinds_of(color);
  int on_ball = 0, wrong = 0;
  for (int y = 0; y < 480; y += 2) {
    for (int x = 0; x < 640; x += 2) {
      if (kinds(y, x) != kBallSurface || !is_clear(kinds, x, y, 9)) continue;
      ++on_ball;
      const double truth = trace(Eigen::Vector3d::Zero(), ray_of(c, x, y)).p.z();
      wrong += std::abs(out(y, x) - truth) > 0.02 ? 1 : 0;
    }
  }
  EXPECT_GT(on_ball, 4000);
  EXPECT_EQ(wrong, 0);
}

TEST(DepthRegistration, TakesNoPointBehindOrBesideTheColorCamera) {
  const CameraModel c = camera_of(64, 48, 60);
  const CameraModel color =
      with_depth_camera(c, c, Eigen::Isometry3d(Eigen::Translation3d(0, 0, -1.5)));
  const cv::Mat1f out = DepthRegistration(color).to_color(DepthImage(cv::Mat1f(48, 64, 1.52F))).mat;
  EXPECT_EQ(cv::countNonZero(out), 0);
}

}  // namespace
}  // namespace stillmap
