// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulated_world.hpp"

#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"
#include "tests/support/simulated_map.hpp"

namespace stillmap {
namespace {

Eigen::Isometry3d some_pose() {
  return make_pose(so3_exp(Eigen::Vector3d(0.1, -0.2, 0.05)), Eigen::Vector3d(0.2, 0.1, -0.3));
}

// Camera that walks sideways at 0.5 m/s and turns at 0.3 rad/s.
Eigen::Isometry3d walking(double time_s) {
  return make_pose(so3_exp(Eigen::Vector3d(0, 0.3 * time_s, 0)),
                   Eigen::Vector3d(0.5 * time_s, 0, 0));
}

TEST(SimulatedWorld, ExactFeaturesLeadBackToTheirPoints) {
  CameraModel camera = simulated_camera();
  camera.k1 = 0.1;
  camera.p1 = -0.002;
  const SimulatedWorld world({}, camera);
  std::mt19937 rng(3);
  const Observed seen = world.observe(some_pose(), {}, rng);
  ASSERT_GT(seen.features.size(), 200U);
  for (std::size_t i = 0; i < seen.features.size(); ++i) {
    const Eigen::Vector3d p_camera =
        camera.unproject(camera.undistort(seen.features.raw_px[i].cast<double>()),
                         static_cast<double>(seen.features.depth_m[i]));
    const WorldPoint& truth = world.points()[seen.points[i]];
    EXPECT_LT((some_pose() * p_camera - truth.position).norm(), 1e-5);
    EXPECT_EQ(seen.features.descriptors[i], truth.descriptor);
  }
}

TEST(SimulatedWorld, RowsOfARollingShutterAreSeenFromWhereTheCameraIsThen) {
  const SimulatedWorld world({}, simulated_camera());
  constexpr double kReadout = 0.03;
  std::mt19937 rng(3);
  const Observed seen = world.observe_rolling(walking, 1.0, kReadout, {}, rng);
  ASSERT_GT(seen.features.size(), 200U);
  double most_moved_px = 0;
  for (std::size_t i = 0; i < seen.features.size(); ++i) {
    const Eigen::Vector2d px = seen.features.raw_px[i].cast<double>();
    const double time_s = 1.0 + kReadout * (px.y() / world.camera().height_px - 0.5);
    const Eigen::Vector3d& p_world = world.points()[seen.points[i]].position;
    const Eigen::Vector2d then = world.camera().project(walking(time_s).inverse() * p_world);
    const Eigen::Vector2d middle = world.camera().project(walking(1.0).inverse() * p_world);
    EXPECT_LT((px - then).norm(), 1e-4);
    most_moved_px = std::max(most_moved_px, (px - middle).norm());
  }
  EXPECT_GT(most_moved_px, 2.0);
}

TEST(SimulatedWorld, NoiseIsAsLargeAsAsked) {
  const SimulatedWorld world({}, simulated_camera());
  std::mt19937 rng(3);
  const Observed seen =
      world.observe(some_pose(), {.pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.02}, rng);
  double px = 0, inverse_depth = 0;
  for (std::size_t i = 0; i < seen.features.size(); ++i) {
    const Eigen::Vector3d p_camera =
        some_pose().inverse() * world.points()[seen.points[i]].position;
    const double scale = static_cast<double>(world.level_scales()[seen.features.level[i]]);
    px += (seen.features.px[i].cast<double>() - world.camera().project(p_camera)).squaredNorm() /
          (scale * scale);
    inverse_depth +=
        std::pow(1.0 / static_cast<double>(seen.features.depth_m[i]) - 1.0 / p_camera.z(), 2);
  }
  const auto count = static_cast<double>(seen.features.size());
  EXPECT_NEAR(std::sqrt(px / count / 2), 0.5, 0.05);
  EXPECT_NEAR(std::sqrt(inverse_depth / count), 0.02, 0.003);
}

TEST(SimulatedMap, IsConsistentAndTrue) {
  const SimulatedWorld world({}, simulated_camera());
  std::mt19937 rng(3);
  const std::vector<Eigen::Isometry3d> poses = {walking(0), walking(0.5), walking(1)};
  const SimulatedMap simulated = make_true_map(world, poses, {}, rng);
  simulated.map.check_consistency();
  std::size_t observations = 0, features = 0;
  for (const LandmarkId id : simulated.map.landmark_ids()) {
    const Landmark& landmark = simulated.map.landmark(id);
    observations += landmark.observations.size();
    EXPECT_EQ(landmark.p_world, world.points()[true_point(simulated, landmark)].position);
  }
  for (const std::vector<std::uint32_t>& points : simulated.points) features += points.size();
  EXPECT_EQ(observations, features);
}

}  // namespace
}  // namespace stillmap
