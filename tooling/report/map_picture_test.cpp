// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/map_picture.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/core/random.hpp"

namespace stillmap {
namespace {

constexpr Rgb kRed = {200, 10, 20};
constexpr Rgb kBlue = {10, 20, 200};

View plain_view() {
  View view;
  view.width_px = 80;
  view.height_px = 60;
  view.scale = 50;
  view.point_size_m = 0;
  view.shade_depth_steps = false;
  view.background = {255, 255, 255};
  return view;
}

Rgb pixel(const ColorImage& image, int x, int y) {
  const cv::Vec3b c = image.mat(y, x);
  return {c[0], c[1], c[2]};
}

TEST(LookAt, AxesOfTheCamera) {
  const Eigen::Isometry3d T = look_at({1, 2, 3}, {1, 2, 8}, {0, 1, 0});
  EXPECT_TRUE((T * Eigen::Vector3d(1, 2, 3)).isZero(1e-12));
  EXPECT_TRUE((T * Eigen::Vector3d(2, 2, 3)).isApprox(Eigen::Vector3d(1, 0, 0)));
  EXPECT_TRUE((T * Eigen::Vector3d(1, 3, 3)).isApprox(Eigen::Vector3d(0, 1, 0)));
  EXPECT_TRUE((T * Eigen::Vector3d(1, 2, 5)).isApprox(Eigen::Vector3d(0, 0, 2)));
  const Eigen::Isometry3d from_above = look_at({0, -5, 0}, {0, 0, 0}, {0, 0, -1});
  EXPECT_TRUE((from_above * Eigen::Vector3d(1, 0, 2)).isApprox(Eigen::Vector3d(1, -2, 5)));
  EXPECT_NEAR(from_above.linear().determinant(), 1, 1e-12);
}

TEST(RenderPoints, PointsFallWhereTheyProjectByHand) {
  PointCloud cloud;
  cloud.positions = {{0.2F, -0.1F, 2.0F}, {-0.59F, 0.41F, 1.0F}};
  cloud.colors = {kRed, kBlue};
  const ColorImage image = render_points(cloud, plain_view());
  EXPECT_EQ(pixel(image, 45, 27), kRed);   // 40 + 50 * 0.2 / 2 = 45, 30 - 50 * 0.1 / 2 = 27.5
  EXPECT_EQ(pixel(image, 10, 50), kBlue);  // 40 - 29.5, 30 + 20.5
  EXPECT_EQ(pixel(image, 46, 27), (Rgb{255, 255, 255}));
}

TEST(RenderPoints, OrthographicPointsDoNotShrinkWithDistance) {
  PointCloud cloud;
  cloud.positions = {{0.25F, 0.25F, 2.0F}, {-0.35F, 0.25F, 70.0F}};
  cloud.colors = {kRed, kBlue};
  View view = plain_view();
  view.orthographic = true;
  view.point_size_m = 0.06;  // 3 pixels
  const ColorImage image = render_points(cloud, view);
  for (int y = 41; y <= 43; ++y) {  // about 42.5, whose pixel is 42
    for (int x = 51; x <= 53; ++x) EXPECT_EQ(pixel(image, x, y), kRed);
    for (int x = 21; x <= 23; ++x) EXPECT_EQ(pixel(image, x, y), kBlue);
  }
  EXPECT_EQ(pixel(image, 50, 42), (Rgb{255, 255, 255}));
  EXPECT_EQ(pixel(image, 54, 42), (Rgb{255, 255, 255}));
}

// The nearest point of each pixel, by the definition, one pixel at a time.
TEST(RenderPoints, AgreesWithBruteForce) {
  std::mt19937 rng(7);
  const auto uniform = [&rng](double low, double high) {
    return low + (high - low) * draw_index(rng, 1U << 30U) / (1U << 30U);
  };
  PointCloud cloud;
  for (int i = 0; i < 3000; ++i) {
    cloud.positions.emplace_back(uniform(-2, 2), uniform(-2, 2), uniform(-1, 4));
    cloud.colors.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8), 7});
  }
  View view = plain_view();
  view.T_camera_world = look_at({0.3, -0.5, -1}, {0, 0, 2}, {0.1, 1, 0});
  const ColorImage image = render_points(cloud, view);
  for (int y = 0; y < view.height_px; ++y) {
    for (int x = 0; x < view.width_px; ++x) {
      Rgb expected = view.background;
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3d p = view.T_camera_world * cloud.positions[i].cast<double>();
        if (p.z() < view.near_m || p.z() >= nearest) continue;
        const bool here =
            std::floor(50 * p.x() / p.z() + 40) == x && std::floor(50 * p.y() / p.z() + 30) == y;
        if (!here) continue;
        nearest = p.z();
        expected = cloud.colors[i];
      }
      ASSERT_EQ(pixel(image, x, y), expected) << x << ' ' << y;
    }
  }
}

TEST(RenderPoints, OfEquallyNearPointsTheFirstWinsAndHostileOnesAreLeftOut) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  PointCloud cloud;
  cloud.positions = {{0, 0, 1}, {0, 0, 1}, {kNan, 0, 1}, {0, 0, 0}, {0, 0, -1}, {1e30F, 0, 1e-1F}};
  cloud.colors = {kRed, kBlue, kBlue, kBlue, kBlue, kBlue};
  const ColorImage image = render_points(cloud, plain_view());
  EXPECT_EQ(pixel(image, 40, 30), kRed);
  EXPECT_EQ(cv::countNonZero(image.mat.reshape(1) != 255), 3);  // the channels of that one pixel
}

TEST(RenderPoints, ShadingDarkensWhatLiesJustBehindAnEdgeAndNothingElse) {
  PointCloud cloud;
  for (int y = -20; y <= 20; ++y) {
    for (int x = -20; x <= 20; ++x) {
      cloud.positions.emplace_back(0.02F * x, 0.02F * y, x < 0 ? 1.0F : 3.0F);
      cloud.colors.push_back({200, 200, 200});
    }
  }
  View view = plain_view();
  view.orthographic = true;
  view.shade_depth_steps = true;
  const ColorImage image = render_points(cloud, view);
  EXPECT_EQ(pixel(image, 30, 30), (Rgb{200, 200, 200}));  // in front
  EXPECT_EQ(pixel(image, 50, 30), (Rgb{200, 200, 200}));  // behind, away from the edge
  EXPECT_LT(pixel(image, 40, 30)[0], 170);                // behind, at the edge
}

TEST(RenderPoints, OfAnEmptyCloudIsBackground) {
  const ColorImage image = render_points(PointCloud{}, plain_view());
  EXPECT_EQ(image.mat.size(), cv::Size(80, 60));
  EXPECT_EQ(cv::countNonZero(image.mat.reshape(1) != 255), 0);
}

TEST(DrawPath, GoesThroughItsPointsOnACopy) {
  const ColorImage blank = render_points(PointCloud{}, plain_view());
  const std::vector<Eigen::Vector3d> path = {{-0.5, 0, 1}, {0.5, 0, 1}, {0, 0, -1}, {1e9, 0, 1}};
  const ColorImage drawn = draw_path(blank, plain_view(), path, kRed);
  EXPECT_EQ(pixel(drawn, 20, 30), kRed);
  EXPECT_EQ(pixel(drawn, 60, 30), kRed);
  EXPECT_EQ(pixel(drawn, 40, 50), (Rgb{255, 255, 255}));
  EXPECT_EQ(pixel(blank, 20, 30), (Rgb{255, 255, 255}));
}

StampedPose pose_at(double seconds, const Eigen::Vector3d& place) {
  StampedPose pose;
  pose.stamp.seconds = seconds;
  pose.T_world_camera.translation() = place;
  return pose;
}

TEST(ContinuousParts, AreCutAtGaps) {
  const Trajectory poses = {
      pose_at(1.0, {0, 0, 0}), pose_at(1.5, {1, 0, 0}), pose_at(2.1, {2, 0, 0})};
  const std::vector<std::vector<Eigen::Vector3d>> parts = continuous_parts(poses);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].size(), 2U);
  EXPECT_EQ(parts[1][0].x(), 2);
  EXPECT_TRUE(continuous_parts({}).empty());
}

TEST(RenderTriangles, PixelsWhoseRaysMeetATriangle) {
  // Corners anywhere before the camera; the truth by cutting the ray of each pixel's centre.
  std::mt19937 random(5);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  PointCloud vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Rgb color = {static_cast<std::uint8_t>(20 * i), 100, 200};
    for (int corner = 0; corner < 3; ++corner) {
      const double z = uniform(1, 4);
      vertices.positions.push_back(
          Eigen::Vector3d(uniform(-0.8, 0.8) * z, uniform(-0.6, 0.6) * z, z).cast<float>());
      vertices.colors.push_back(color);
    }
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const ColorImage image = render_triangles(vertices, triangles, plain_view());
  int filled = 0;
  for (int v = 0; v < 60; ++v) {
    for (int u = 0; u < 80; ++u) {
      const Eigen::Vector3d ray((u + 0.5 - 40) / 50, (v + 0.5 - 30) / 50, 1);
      double nearest = 1e9;
      Rgb expected = {255, 255, 255};
      for (const std::array<std::uint32_t, 3>& t : triangles) {
        Eigen::Matrix3d corners;
        for (int k = 0; k < 3; ++k) {
          corners.col(k) = vertices.positions[t[static_cast<std::size_t>(k)]].cast<double>();
        }
        const Eigen::Vector3d weights = corners.inverse() * ray;  // of the corners, up to scale
        const double z = 1 / weights.sum();
        if (weights.minCoeff() * z < 0 || z <= 0 || z >= nearest) continue;
        nearest = z;
        expected = vertices.colors[t[0]];
      }
      filled += nearest < 1e9 ? 1 : 0;
      EXPECT_EQ(pixel(image, u, v), expected) << u << " " << v;
    }
  }
  EXPECT_GT(filled, 400);
}

TEST(RenderTriangles, ColorsGoOverFromCornerToCorner) {
  PointCloud square;
  square.positions = {{-0.5F, -0.5F, 1}, {0.5F, -0.5F, 1}, {0.5F, 0.5F, 1}, {-0.5F, 0.5F, 1}};
  square.colors = {{0, 0, 0}, {200, 0, 0}, {200, 100, 0}, {0, 100, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 2}, {0, 3, 2}};
  View view = plain_view();
  view.orthographic = true;  // 50 pixels in a metre: the square is 50 pixels wide
  const ColorImage image = render_triangles(square, triangles, view);
  for (const int x : {16, 30, 52, 63}) {
    for (const int y : {6, 20, 53}) {
      EXPECT_NEAR(pixel(image, x, y)[0], 200 * (x + 0.5 - 15) / 50, 0.5001);
      EXPECT_NEAR(pixel(image, x, y)[1], 100 * (y + 0.5 - 5) / 50, 0.5001);
    }
  }
  EXPECT_EQ(pixel(image, 14, 20), (Rgb{255, 255, 255}));
  EXPECT_EQ(pixel(image, 65, 20), (Rgb{255, 255, 255}));
}

TEST(RenderTriangles, ThoseBeforeTheLimitAreNotDrawn) {
  PointCloud vertices;
  vertices.positions = {{-1, -1, -1}, {1, -1, 2}, {0, 1, 2}};
  vertices.colors = {kRed, kRed, kRed};
  const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 2}};
  const ColorImage image = render_triangles(vertices, triangles, plain_view());
  for (const cv::Vec3b& color : image.mat) EXPECT_EQ(color, cv::Vec3b(255, 255, 255));
}

}  // namespace
}  // namespace stillmap
