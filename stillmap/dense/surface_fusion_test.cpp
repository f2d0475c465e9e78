// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/surface_fusion.hpp"

#include <cmath>
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
  NoisyViews(const Plane& plane, int count, double noise_per_m) {
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
          const double z = (plane.offset_m - plane.normal.dot(T_world_camera.translation())) /
                           plane.normal.dot(T_world_camera.linear() * ray);
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
        stitched(), posed(), camera_, cell_side(camera_.width_px, config_), kVoxel_m, {}, threads);
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

TEST(SurfaceFusion, PointsThatNoViewMeasuresStay) {
  const NoisyViews views(kWall, 3, 0);
  PointCloud far;
  far.positions = {{0, 0, 2}, {0, 0, -3}};
  far.colors = {{1, 2, 3}, {4, 5, 6}};
  const PointCloud fused =
      fused_surface(far, views.posed(), builtin_camera("tum_fr3"), 4, kVoxel_m, {});
  ASSERT_EQ(fused.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t k = fused.colors[i] == far.colors[0] ? 0 : 1;
    EXPECT_EQ(fused.positions[i], far.positions[k]);
    EXPECT_EQ(fused.colors[i], far.colors[k]);
    EXPECT_EQ(fused.normals[i], Eigen::Vector3f::Zero());
  }
  EXPECT_TRUE(fused_surface({}, views.posed(), builtin_camera("tum_fr3"), 4, kVoxel_m, {}).empty());
}

}  // namespace
}  // namespace stillmap
