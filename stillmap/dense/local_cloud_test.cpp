// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/local_cloud.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "tests/support/cameras.hpp"

namespace stillmap {
namespace {

CameraModel small_camera() {
  return centered_camera(64, 48, 50);
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

PointCloud cloud_of(const RgbdFrame& frame,
                    const CameraModel& camera,
                    const LocalCloudConfig& config = {},
                    const cv::Mat1b& labels = {}) {
  return local_cloud(frame.depth.mat, frame.color, pixel_rays(camera), config, LabelImage(labels));
}

TEST(LocalCloud, OnePixelIsItsRayTimesItsDepth) {
  const CameraModel camera = small_camera();
  RgbdFrame frame = frame_of(camera, 0.0F);
  frame.depth.mat(40, 9) = 2.5F;
  const PointCloud cloud = cloud_of(frame, camera);
  ASSERT_EQ(cloud.size(), 1U);
  const Eigen::Vector3f expected(-22.5F / 50 * 2.5F, 16.5F / 50 * 2.5F, 2.5F);
  EXPECT_LT((cloud.positions[0] - expected).norm(), 1e-6F);
  EXPECT_EQ(cloud.colors[0], (Rgb{9, 40, 77}));
  EXPECT_TRUE(cloud.labels.empty());
  EXPECT_TRUE(cloud.normals.empty());
}

TEST(LocalCloud, EmptyWithoutDepthOrPixels) {
  const CameraModel camera = small_camera();
  EXPECT_TRUE(cloud_of(frame_of(camera, 0.0F), camera).empty());
  EXPECT_TRUE(local_cloud({}, {}, {}, {}).empty());
}

TEST(LocalCloud, APlaneStaysAPlane) {
  const CameraModel camera = builtin_camera("tum_fr1");  // its images are distorted
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  RgbdFrame frame = frame_of(camera, 0.0F);
  render_plane(frame, camera, normal, 1.3);
  for (float& z : frame.depth.mat) z = z > 0 && z < 4 ? z : 0.0F;
  const PointCloud cloud = cloud_of(frame, camera);
  EXPECT_GT(cloud.size(), 10000U);
  EXPECT_LT(cloud.size(), 30000U);
  for (const Eigen::Vector3f& p : cloud.positions) {
    ASSERT_NEAR(normal.dot(p.cast<double>()), 1.3, 5e-6);
  }
}

/// The same the plain way: the pixels of each point are kept, and means taken anew for each.
PointCloud brute_force_cloud(const RgbdFrame& frame,
                             const CameraModel& camera,
                             int side_px,
                             const LocalCloudConfig& config) {
  const cv::Mat2f rays = pixel_rays(camera);
  std::map<std::array<int, 2>, std::vector<std::vector<cv::Point>>> cells;
  const auto mean = [](const std::vector<cv::Point>& pixels, auto value_of) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const cv::Point& p : pixels) sum += value_of(p);
    return Eigen::Vector3d(sum / static_cast<double>(pixels.size()));
  };
  const auto position = [&](const cv::Point& p) {
    return Eigen::Vector3d(Eigen::Vector3d(rays(p)[0], rays(p)[1], 1) * frame.depth.mat(p));
  };
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const auto z = static_cast<double>(frame.depth.mat(y, x));
      if (z == 0) continue;
      const double reach = config.join_per_m * std::pow(z + config.join_offset_m, 2);
      std::vector<std::vector<cv::Point>>& points = cells[{y / side_px, x / side_px}];
      auto point = points.rbegin();
      while (point != points.rend() && std::abs(mean(*point, position).z() - z) > reach) ++point;
      if (point == points.rend()) {
        points.push_back({{x, y}});
      } else {
        point->push_back({x, y});
      }
    }
  }
  PointCloud cloud;
  for (const auto& [cell, points] : cells) {
    for (const std::vector<cv::Point>& pixels : points) {
      cloud.positions.push_back(mean(pixels, position).cast<float>());
      const Eigen::Vector3d color = mean(pixels, [&](const cv::Point& p) {
        const cv::Vec3b rgb = frame.color.mat(p);
        return Eigen::Vector3d(rgb[0], rgb[1], rgb[2]);
      });
      Rgb rounded{};
      for (int c = 0; c < 3; ++c) {
        rounded[static_cast<std::size_t>(c)] =
            static_cast<std::uint8_t>(std::floor(color[c] + 0.5));
      }
      cloud.colors.push_back(rounded);
    }
  }
  return cloud;
}

TEST(LocalCloud, AgreesWithBruteForce) {
  CameraModel camera = small_camera();
  camera.width_px = 62;  // no multiple of the cell
  std::mt19937 rng(6);
  std::uniform_int_distribution<int> level(0, 7);
  RgbdFrame frame = frame_of(camera, 0.0F);
  for (float& z : frame.depth.mat) z = static_cast<float>(level(rng)) * 0.503F;
  const LocalCloudConfig config{16, 0.07, 0.4};
  const PointCloud expected = brute_force_cloud(frame, camera, 4, config);
  const PointCloud cloud = cloud_of(frame, camera, config);
  EXPECT_GT(cloud.size(), 16U * 12 * 2);
  EXPECT_LT(cloud.size(), frame.depth.mat.total() / 2);
  ASSERT_EQ(cloud.size(), expected.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_LT((cloud.positions[i] - expected.positions[i]).norm(), 1e-5F) << i;
  }
  EXPECT_EQ(cloud.colors, expected.colors);
}

TEST(LocalCloud, AMeanIsNearerToAFarWallThanItsPixels) {
  CameraModel camera = builtin_camera("tum_fr3");
  std::mt19937 rng(9);
  std::normal_distribution<float> noise(0, 0.0015F * 16);
  RgbdFrame frame = frame_of(camera, 4.0F);
  for (float& z : frame.depth.mat) z += noise(rng);
  const PointCloud cloud = cloud_of(frame, camera);
  EXPECT_LT(cloud.size(), frame.depth.mat.total() / 8);
  double error = 0;
  for (const Eigen::Vector3f& p : cloud.positions) error += std::abs(p.z() - 4.0F);
  const double of_pixels = 0.0015 * 16 * std::sqrt(2 / 3.14159265);
  EXPECT_LT(error / static_cast<double>(cloud.size()), 0.6 * of_pixels);
}

TEST(LocalCloud, LeavesOutRaysThatAreNotFiniteOrTooSteep) {
  const CameraModel camera = small_camera();
  cv::Mat2f rays = pixel_rays(camera);
  rays(0, 0)[0] = std::numeric_limits<float>::quiet_NaN();
  rays(0, 1)[1] = std::numeric_limits<float>::infinity();
  rays(0, 2)[0] = -1e30F;
  const std::size_t pixels = rays.total();  // a cell for each
  const RgbdFrame frame = frame_of(camera, 1.0F);
  EXPECT_EQ(local_cloud(frame.depth.mat, frame.color, rays, {}).size(), pixels - 3);
  EXPECT_EQ(cloud_of(frame, camera).size(), pixels);
}

TEST(LocalCloud, RefusesRaysOfAnotherSize) {
  const RgbdFrame frame = frame_of(small_camera(), 1.0F);
  EXPECT_THROW((void)local_cloud(frame.depth.mat, frame.color, cv::Mat2f(48, 63), {}),
               InternalError);
}

TEST(LocalCloud, LabelsAreThoseOfMostPixelsOfAPoint) {
  const CameraModel camera = small_camera();
  const RgbdFrame frame = frame_of(camera, 1.0F);
  cv::Mat1b labels(camera.height_px, camera.width_px, std::uint8_t{0});
  labels(cv::Rect(32, 24, 2, 4)).setTo(57);  // 8 of 16
  labels(cv::Rect(36, 24, 3, 3)).setTo(63);  // 9 of 16
  const LocalCloudConfig config{.cells_across = 16};
  const PointCloud cloud = cloud_of(frame, camera, config, labels);
  ASSERT_EQ(cloud.size(), 16U * 12);
  ASSERT_EQ(cloud.labels.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_EQ(cloud.labels[i], i == 6 * 16 + 9 ? 63 : 0) << i;  // row 6, column 9 of the cells
  }
  // Labels change nothing else.
  const PointCloud plain = cloud_of(frame, camera, config);
  EXPECT_EQ(cloud.positions, plain.positions);
  EXPECT_EQ(cloud.colors, plain.colors);
}

TEST(LocalCloud, APointOfMorePixelsThanVotesHasALabel) {
  CameraModel camera = builtin_camera("tum_fr3");
  const RgbdFrame frame = frame_of(camera, 1.5F);
  const cv::Mat1b labels(480, 640, std::uint8_t{57});
  const PointCloud cloud = cloud_of(frame, camera, {.cells_across = 1}, labels);
  ASSERT_EQ(cloud.size(), 1U);
  EXPECT_EQ(cloud.labels[0], 57);
}

}  // namespace
}  // namespace stillmap
