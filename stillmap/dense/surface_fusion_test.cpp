// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/surface_fusion.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/dense/local_cloud.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {
namespace {

constexpr double kVoxel_m = 0.01;

/// A plane n p = offset_m in the world.
struct Plane {
  Eigen::Vector3d normal;  // unit, towards the cameras
  double offset_m;

  [[nodiscard]] double distance(const Eigen::Vector3f& p) const {
    return normal.dot(p.cast<double>()) - offset_m;
  }
};

/// Views of a plane with the noise of a depth camera in each pixel.
class NoisyViews {
 public:
  NoisyViews(const Plane& plane, int count, double noise_per_m)
      : NoisyViews(
            [plane](const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
              return (plane.offset_m - plane.normal.dot(from)) / plane.normal.dot(along);
            },
            count,
            noise_per_m) {}

  /// `depth` is that along a ray whose z in the camera is 1.
  NoisyViews(
      const std::function<double(const Eigen::Vector3d&, const Eigen::Vector3d&)>& depth_along,
      int count,
      double noise_per_m) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0.0, 1.0);
    for (int k = 0; k < count; ++k) {
      Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
      T_world_camera.translation() = Eigen::Vector3d(0.02 * k, 0.01 * k, 0);
      T_world_camera.rotate(Eigen::AngleAxisd(0.01 * k, Eigen::Vector3d::UnitY()));
      cv::Mat1f depth(camera_.height_px, camera_.width_px);
      for (int v = 0; v < depth.rows; ++v) {
        for (int u = 0; u < depth.cols; ++u) {
          const Eigen::Vector3d ray(rays_(v, u)[0], rays_(v, u)[1], 1);
          const double z = depth_along(T_world_camera.translation(), T_world_camera.linear() * ray);
          depth(v, u) = static_cast<float>(z + noise_per_m * z * z * normal(random));
        }
      }
      clouds_.push_back(compact(local_cloud(depth, color_, rays_, config_)));
      poses_.push_back(T_world_camera);
    }
  }

  [[nodiscard]] std::vector<PosedCloud> posed() const {
    std::vector<PosedCloud> posed;
    for (std::size_t k = 0; k < clouds_.size(); ++k) posed.push_back({poses_[k], &clouds_[k]});
    return posed;
  }
  [[nodiscard]] PointCloud stitched() const { return global_cloud(posed(), kVoxel_m); }
  [[nodiscard]] PointCloud fused(std::size_t threads = 1) const {
    return fused_surface(
        posed(), camera_, cell_side(camera_.width_px, config_), kVoxel_m, {}, threads);
  }

 private:
  CameraModel camera_ = builtin_camera("tum_fr3");
  cv::Mat2f rays_ = pixel_rays(camera_);
  ColorImage color_{cv::Mat3b(camera_.height_px, camera_.width_px, cv::Vec3b(10, 20, 30))};
  LocalCloudConfig config_;
  std::vector<CompactCloud> clouds_;
  std::vector<Eigen::Isometry3d> poses_;
};

/// The root mean square of the distances.
double rms(const PointCloud& map, const Plane& plane) {
  double sum = 0;
  for (const Eigen::Vector3f& p : map.positions) sum += std::pow(plane.distance(p), 2);
  return std::sqrt(sum / static_cast<double>(map.size()));
}

const Plane kWall{{0, 0, -1}, -4};
const Plane kSlanting{Eigen::Vector3d(0.6, 0, -0.8).normalized(), -2.4};

TEST(SurfaceFusion, ManyNoisyViewsMakeOneThinWall) {
  for (const Plane& plane : {kWall, kSlanting}) {
    const NoisyViews views(plane, 12, 0.0015);
    const PointCloud fused = views.fused();
    // The mean of 12 views has at most a third of the noise of one.
    EXPECT_LT(rms(fused, plane), rms(views.stitched(), plane) / 3);
    EXPECT_LT(rms(fused, plane), 0.006);
    EXPECT_GT(fused.size(), 20000U);
  }
}

TEST(SurfaceFusion, NormalsStandOnTheSurfaceAndFaceTheCameras) {
  for (const Plane& plane : {kWall, kSlanting}) {
    const PointCloud fused = NoisyViews(plane, 12, 0.0015).fused();
    ASSERT_EQ(fused.normals.size(), fused.size());
    double sum = 0;
    std::size_t count = 0;
    for (const Eigen::Vector3f& normal : fused.normals) {
      if (normal.isZero()) continue;  // no view measures surface there: the noise of one pixel
      ASSERT_NEAR(normal.norm(), 1, 1e-4);
      sum += normal.cast<double>().dot(plane.normal);
      ++count;
    }
    EXPECT_GT(count, fused.size() * 95 / 100);
    EXPECT_GT(sum / static_cast<double>(count), std::cos(0.12));  // 7 degrees
  }
}

TEST(SurfaceFusion, ThereIsOnePointInAVoxel) {
  const PointCloud fused = NoisyViews(kWall, 5, 0.002).fused();
  std::set<std::array<int, 3>> voxels;
  std::size_t outside = 0;  // the mean may round to the next voxel's face
  for (const Eigen::Vector3f& p : fused.positions) {
    const Eigen::Vector3i v = (p.cast<double>() / kVoxel_m).array().floor().cast<int>();
    outside += voxels.insert({v.x(), v.y(), v.z()}).second ? 0 : 1;
  }
  EXPECT_LE(outside, fused.size() / 1000);
}

TEST(SurfaceFusion, ThreadsChangeNothing) {
  const NoisyViews views(kSlanting, 4, 0.002);
  const PointCloud one = views.fused(1), three = views.fused(3);
  EXPECT_EQ(one.positions, three.positions);
  EXPECT_EQ(one.normals, three.normals);
  EXPECT_EQ(one.colors, three.colors);
}

TEST(SurfaceFusion, PointsThatNoOtherViewMeasuresStay) {
  const NoisyViews views(kWall, 3, 0);
  PointCloud lonely;  // two points of one cell, whose surface is therefore unknown
  lonely.positions = {{0, 0, 1.5F}, {0, 0, 2}};
  lonely.colors = {{1, 2, 3}, {4, 5, 6}};
  const CompactCloud view = compact(lonely);
  std::vector<PosedCloud> posed = views.posed();
  const std::size_t wall = fused_surface(posed, builtin_camera("tum_fr3"), 4, kVoxel_m, {}).size();
  posed.push_back({Eigen::Isometry3d::Identity(), &view});
  const PointCloud fused = fused_surface(posed, builtin_camera("tum_fr3"), 4, kVoxel_m, {});
  EXPECT_EQ(fused.size(), wall + 2);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto found = std::ranges::find(fused.colors, lonely.colors[k]);
    ASSERT_NE(found, fused.colors.end());
    const auto i = static_cast<std::size_t>(found - fused.colors.begin());
    EXPECT_LT((fused.positions[i] - lonely.positions[k]).norm(), 1e-5F);
    EXPECT_EQ(fused.normals[i], Eigen::Vector3f::Zero());
  }
  EXPECT_TRUE(fused_surface({}, builtin_camera("tum_fr3"), 4, kVoxel_m, {}).empty());
}

/// A step of 3 cm is lower than the cubes whose points move to one plane.
TEST(SurfaceFusion, AStepLowerThanACubeStays) {
  constexpr double kEdge_m = 0.013;
  const auto depth = [](double x) { return x < kEdge_m ? 1.0 : 1.03; };
  const NoisyViews views(
      [&](const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
        const double low = (1.0 - from.z()) / along.z();
        return (depth(from.x() + low * along.x()) - from.z()) / along.z();
      },
      6,
      0.0005);
  std::size_t count = 0, wrong = 0;
  for (const Eigen::Vector3f& p : views.fused().positions) {
    if (std::abs(p.x() - kEdge_m) < 0.015) continue;
    ++count;
    wrong += std::abs(p.z() - depth(p.x())) > 0.005 ? 1 : 0;
  }
  EXPECT_GT(count, 5000U);
  EXPECT_LT(wrong, count / 100);
}

}  // namespace
}  // namespace stillmap
