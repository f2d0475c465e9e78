// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/see_through.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"
#include "tests/support/cameras.hpp"

namespace stillmap {
namespace {

CameraModel small_camera() {
  return centered_camera(64, 48, 50);
}

DepthImage wall_at(double z) {
  return DepthImage(cv::Mat1f(48, 64, static_cast<float>(z)));
}

std::size_t seen_through(const Eigen::Vector3d& p, const DepthImage& depth, int frames) {
  SeeThroughTest test(small_camera(), {p.cast<float>()});
  for (int i = 0; i < frames; ++i) test.add(depth, Eigen::Isometry3d::Identity());
  return test.result().seen_through;
}

TEST(SeeThrough, TakesThreeFramesAndMoreThanNoise) {
  // At 2 m: 0.05 + 3 * 0.0015 * 4 = 0.068 m.
  EXPECT_EQ(seen_through({0, 0, 1.930}, wall_at(2), 3), 1U);
  EXPECT_EQ(seen_through({0, 0, 1.930}, wall_at(2), 2), 0U);
  EXPECT_EQ(seen_through({0, 0, 1.934}, wall_at(2), 9), 0U);
  // At 4 m: 0.05 + 3 * 0.0015 * 16 = 0.122 m.
  EXPECT_EQ(seen_through({0, 0, 3.876}, wall_at(4), 3), 1U);
  EXPECT_EQ(seen_through({0, 0, 3.880}, wall_at(4), 9), 0U);
}

TEST(SeeThrough, SaysNothingOfWhatIsNotInView) {
  EXPECT_EQ(seen_through({0, 0, -1}, wall_at(2), 3), 0U);     // behind the camera
  EXPECT_EQ(seen_through({0, 0, 3}, wall_at(2), 3), 0U);      // behind the wall
  EXPECT_EQ(seen_through({0.65, 0, 1}, wall_at(2), 3), 0U);   // column 64
  EXPECT_EQ(seen_through({0.63, 0, 1}, wall_at(2), 3), 1U);   // column 63
  EXPECT_EQ(seen_through({0, -0.47, 1}, wall_at(2), 3), 1U);  // row 0
  EXPECT_EQ(seen_through({0, -0.49, 1}, wall_at(2), 3), 0U);  // row -1
  EXPECT_EQ(seen_through({0, 0, 1}, wall_at(0), 3), 0U);      // no depth there
  EXPECT_EQ(seen_through({0, 0, 1}, wall_at(std::nan("")), 3), 0U);
}

TEST(SeeThrough, CountsItsPointsAndFrames) {
  SeeThroughTest test(small_camera(), {{0, 0, 1}, {0, 0, 2}, {0, 0, 0.5F}, {0, 0, 3}});
  for (int i = 0; i < 5; ++i) test.add(wall_at(2), Eigen::Isometry3d::Identity());
  EXPECT_EQ(test.result().points, 4U);
  EXPECT_EQ(test.result().seen_through, 2U);
  EXPECT_EQ(test.result().frames, 5U);
  EXPECT_EQ(test.result().ratio(), 0.5);
  EXPECT_EQ(SeeThroughTest(small_camera(), {}).result().ratio(), 0.0);
}

TEST(SeeThrough, TellsSurfaceUnderNoiseFromWhatIsNotThere) {
  // The first point is a surface that noise hides now and then, the second one a person who soon
  // left.
  SeeThroughTest test(small_camera(), {{0, 0, 2}, {0.1F, 0, 1.5F}});
  for (int i = 0; i < 8; ++i) {
    DepthImage depth = wall_at(2);
    if (i % 2 == 0) depth.mat(24, 32) = 2.3F;  // the pixel of the first point
    if (i < 3) depth.mat.colRange(34, 38).setTo(1.5F);
    test.add(depth, Eigen::Isometry3d::Identity());
  }
  EXPECT_EQ(test.result().seen_through, 2U);
  EXPECT_EQ(test.result().by_noise, 1U);
  EXPECT_EQ(test.result().ratio(), 1.0);
  EXPECT_EQ(test.result().noise_floor(), 0.5);
}

// The other way round: for each point, of all pixels the one whose ray passes nearest to it. A
// distorted camera is tested without its formulas for distorting, by the rays of its pixels.
bool sees_through_by_rays(const cv::Mat2f& rays,
                          const DepthImage& depth,
                          const Eigen::Vector3d& p) {
  if (p.z() <= 0) return false;
  const Eigen::Vector2d direction = p.head<2>() / p.z();
  double best = 1e9;
  cv::Point at;
  for (int v = 0; v < rays.rows; ++v) {
    for (int u = 0; u < rays.cols; ++u) {
      const double distance = (Eigen::Vector2d(rays(v, u)[0], rays(v, u)[1]) - direction).norm();
      if (distance >= best) continue;
      best = distance;
      at = {u, v};
    }
  }
  const double z = static_cast<double>(depth.mat(at));
  // Only points clearly inside: random points avoid the image's rim.
  return best < 0.8 / 50 && z - p.z() > 0.05 + 3 * 0.0015 * z * z;
}

TEST(SeeThrough, AgreesWithBruteForceWithAndWithoutDistortion) {
  std::mt19937 random(3);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  for (const double k1 : {0.0, 0.25, -0.15}) {
    CameraModel camera = small_camera();
    camera.k1 = k1;
    camera.k2 = -0.3 * k1;
    camera.p1 = 0.02 * k1;
    const cv::Mat2f rays = pixel_rays(camera);
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 400; ++i) {
      const double z = uniform(-1, 4);
      points.push_back(
          Eigen::Vector3d(uniform(-0.4, 0.4) * z, uniform(-0.3, 0.3) * z, z).cast<float>());
    }
    SeeThroughTest test(camera, points);
    std::vector<int> times(points.size(), 0);
    for (int frame = 0; frame < 6; ++frame) {
      DepthImage depth(cv::Mat1f(48, 64));
      for (float& z : depth.mat) z = static_cast<float>(uniform(-1, 5));
      const Eigen::Isometry3d T_world_camera =
          make_pose(so3_exp({uniform(-0.03, 0.03), uniform(-0.03, 0.03), uniform(-0.03, 0.03)}),
                    {uniform(-0.02, 0.02), uniform(-0.02, 0.02), uniform(-0.02, 0.02)});
      test.add(depth, T_world_camera);
      for (std::size_t i = 0; i < points.size(); ++i) {
        times[i] +=
            sees_through_by_rays(rays, depth, T_world_camera.inverse() * points[i].cast<double>());
      }
    }
    const std::ptrdiff_t expected = std::ranges::count_if(times, [](int n) { return n >= 3; });
    ASSERT_GT(expected, 20);
    ASSERT_LT(expected, 380);
    // With distortion the nearest ray and the nearest pixel may differ for points between two.
    EXPECT_NEAR(static_cast<double>(test.result().seen_through),
                static_cast<double>(expected),
                k1 == 0.0 ? 0.0 : 4.0)
        << k1;
  }
}

}  // namespace
}  // namespace stillmap
