// SPDX-License-Identifier: Apache-2.0
#include "stillmap/cloud/local_cloud.hpp"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "stillmap/cloud/brute_force_thinning.hpp"
#include "stillmap/core/camera.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

CameraModel small_camera() {
  CameraModel camera;
  camera.width_px = 64;
  camera.height_px = 48;
  camera.fx = camera.fy = 50;
  camera.cx = 31.5;
  camera.cy = 23.5;
  return camera;
}

/// All pixels with this depth, and with colours that name the pixel.
RgbdFrame frame_of(const CameraModel& camera, float depth_m) {
  RgbdFrame frame;
  frame.depth = DepthImage(cv::Mat1f(camera.height_px, camera.width_px, depth_m));
  cv::Mat3b color(camera.height_px, camera.width_px);
  for (int y = 0; y < color.rows; ++y) {
    for (int x = 0; x < color.cols; ++x) {
      color(y, x) = cv::Vec3b(static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 77);
    }
  }
  frame.color = ColorImage(color);
  return frame;
}

/// The depth at which each ray meets the plane normal . p = distance.
void render_plane(RgbdFrame& frame,
                  const CameraModel& camera,
                  const Eigen::Vector3d& normal,
                  double distance_m) {
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const Eigen::Vector3d ray = camera.unproject(camera.undistort(Eigen::Vector2d(x, y)), 1.0);
      frame.depth.mat(y, x) = static_cast<float>(distance_m / normal.dot(ray));
    }
  }
}

TEST(LocalCloud, OnePixelIsItsRayTimesItsDepth) {
  const CameraModel camera = small_camera();
  RgbdFrame frame = frame_of(camera, 0.0F);
  frame.depth.mat(40, 9) = 2.5F;
  const PointCloud cloud = local_cloud(frame, pixel_rays(camera), {});
  ASSERT_EQ(cloud.size(), 1U);
  const Eigen::Vector3f expected(-22.5F / 50 * 2.5F, 16.5F / 50 * 2.5F, 2.5F);
  EXPECT_LT((cloud.positions[0] - expected).norm(), 1e-6F);
  EXPECT_EQ(cloud.colors[0], (Rgb{9, 40, 77}));
  EXPECT_TRUE(cloud.labels.empty());
  EXPECT_TRUE(cloud.normals.empty());
}

TEST(LocalCloud, LeavesOutMissingAndFarDepth) {
  const CameraModel camera = small_camera();
  RgbdFrame frame = frame_of(camera, 0.0F);
  frame.depth.mat(1, 1) = -1.0F;
  frame.depth.mat(2, 2) = std::numeric_limits<float>::quiet_NaN();
  frame.depth.mat(3, 3) = std::numeric_limits<float>::infinity();
  frame.depth.mat(4, 4) = 3.001F;
  frame.depth.mat(5, 5) = 3.0F;
  frame.depth.mat(6, 6) = 1e-3F;
  const PointCloud cloud = local_cloud(frame, pixel_rays(camera), {.max_depth_m = 3.0});
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.colors[0], (Rgb{5, 5, 77}));
  EXPECT_EQ(cloud.colors[1], (Rgb{6, 6, 77}));
}

TEST(LocalCloud, EmptyWithoutDepthOrPixels) {
  const CameraModel camera = small_camera();
  EXPECT_TRUE(local_cloud(frame_of(camera, 0.0F), pixel_rays(camera), {}).empty());
  EXPECT_TRUE(local_cloud(RgbdFrame{}, cv::Mat2f(), {}).empty());
}

TEST(LocalCloud, APlaneStaysAPlane) {
  const CameraModel camera = builtin_camera("tum_fr1");  // its images are distorted
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  RgbdFrame frame = frame_of(camera, 0.0F);
  render_plane(frame, camera, normal, 1.3);
  const LocalCloudConfig config{.max_depth_m = 4.0, .voxel_size_m = 0.02};
  const PointCloud cloud = local_cloud(frame, pixel_rays(camera), config);
  EXPECT_GT(cloud.size(), 5000U);
  EXPECT_LT(cloud.size(), 60000U);
  for (const Eigen::Vector3f& p : cloud.positions) {
    ASSERT_NEAR(normal.dot(p.cast<double>()), 1.3, 5e-6);
  }
}

TEST(LocalCloud, AgreesWithBruteForce) {
  const CameraModel camera = small_camera();
  const cv::Mat2f rays = pixel_rays(camera);
  std::mt19937 rng(6);
  std::uniform_real_distribution<float> depth(0.5F, 5.0F);
  RgbdFrame frame = frame_of(camera, 0.0F);
  PointCloud points;
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const float z = frame.depth.mat(y, x) = depth(rng);
      if (z > 4.0F) continue;
      points.positions.emplace_back(rays(y, x)[0] * z, rays(y, x)[1] * z, z);
      const cv::Vec3b rgb = frame.color.mat(y, x);
      points.colors.push_back({rgb[0], rgb[1], rgb[2]});
    }
  }
  const PointCloud expected = brute_force_thinning(points, 0.3);
  const PointCloud cloud = local_cloud(frame, rays, {.max_depth_m = 4.0, .voxel_size_m = 0.3});
  ASSERT_EQ(cloud.size(), expected.size());
  EXPECT_LT(cloud.size(), points.size() / 2);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_LT((cloud.positions[i] - expected.positions[i]).norm(), 1e-6F);
  }
  EXPECT_EQ(cloud.colors, expected.colors);
}

TEST(LocalCloud, LeavesOutRaysThatAreNotFiniteOrTooSteep) {
  const CameraModel camera = small_camera();
  cv::Mat2f rays = pixel_rays(camera);
  rays(0, 0)[0] = std::numeric_limits<float>::quiet_NaN();
  rays(0, 1)[1] = std::numeric_limits<float>::infinity();
  rays(0, 2)[0] = -1e30F;
  const std::size_t pixels = rays.total();
  const LocalCloudConfig fine{.max_depth_m = 6.0, .voxel_size_m = 0.001};  // a voxel for each pixel
  EXPECT_EQ(local_cloud(frame_of(camera, 1.0F), rays, fine).size(), pixels - 3);
  EXPECT_EQ(local_cloud(frame_of(camera, 1.0F), pixel_rays(camera), fine).size(), pixels);
}

TEST(LocalCloud, RefusesRaysOfAnotherSize) {
  const CameraModel camera = small_camera();
  EXPECT_THROW((void)local_cloud(frame_of(camera, 1.0F), cv::Mat2f(48, 63), {}), InternalError);
}

TEST(LocalCloud, LabelsAreThoseOfMostPixelsOfAPoint) {
  const CameraModel camera = small_camera();
  const RgbdFrame frame = frame_of(camera, 1.0F);
  const cv::Mat2f rays = pixel_rays(camera);
  // At 1 m a pixel is 2 cm wide: voxels of 10 cm hold 5 by 5 of them; the optical axis is between
  // columns 31 and 32, so that columns 32 to 36 share a voxel, and so on.
  cv::Mat1b labels(camera.height_px, camera.width_px, std::uint8_t{0});
  labels(cv::Rect(32, 24, 2, 5)).setTo(57);  // 10 of 25
  labels(cv::Rect(37, 24, 3, 5)).setTo(63);  // 15 of 25
  const LocalCloudConfig config{.max_depth_m = 6, .voxel_size_m = 0.1};
  const PointCloud cloud = local_cloud(frame, rays, config, {}, labels);
  ASSERT_EQ(cloud.labels.size(), cloud.size());
  int labelled = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f p = cloud.positions[i];
    const bool expected = p.x() > 0.1F && p.x() < 0.2F && p.y() > 0 && p.y() < 0.1F;
    EXPECT_EQ(cloud.labels[i], expected ? 63 : 0) << p.transpose();
    labelled += expected ? 1 : 0;
  }
  EXPECT_EQ(labelled, 1);
  // Labels change nothing else.
  const PointCloud plain = local_cloud(frame, rays, config);
  EXPECT_EQ(cloud.positions, plain.positions);
  EXPECT_EQ(cloud.colors, plain.colors);
}

TEST(LocalCloud, AVoxelOfMorePixelsThanVotesHasALabel) {
  CameraModel camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx = camera.fy = 1e5;  // all rays nearly parallel
  camera.cx = camera.cy = -10;
  RgbdFrame frame;
  frame.depth = DepthImage(cv::Mat1f(480, 640, 1.5F));
  frame.color = ColorImage(cv::Mat3b(480, 640, cv::Vec3b(1, 2, 3)));
  const cv::Mat1b labels(480, 640, std::uint8_t{57});
  const LocalCloudConfig config{.max_depth_m = 6, .voxel_size_m = 1};
  const PointCloud cloud = local_cloud(frame, pixel_rays(camera), config, {}, labels);
  ASSERT_EQ(cloud.size(), 1U);
  EXPECT_EQ(cloud.labels[0], 57);
}

}  // namespace
}  // namespace stillmap
