// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/map/landmark_projection.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/simulated_world.hpp"

namespace stillmap {
namespace {

constexpr double kRadius = 8.0;

const std::vector<float>& scales() {
  static const std::vector<float> kScales = {1.0F, 1.2F, 1.44F, 1.728F};
  return kScales;
}

// A landmark at the world's origin, on level 0 from 4 m, seen so far along z.
Landmark origin_landmark() {
  Landmark landmark;
  landmark.viewing_direction = {0, 0, 1};
  landmark.max_distance_m = 4.0;
  landmark.min_distance_m = 4.0 / 1.728;
  return landmark;
}

// A camera `distance` before the origin, `angle_deg` round it to the side, that looks at it.
Eigen::Isometry3d T_camera_world(double distance, double angle_deg) {
  const double angle = angle_deg * std::numbers::pi / 180.0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(0, 0, distance);
  return T;
}

std::optional<Projection> project(double distance, double angle_deg) {
  const Landmark landmark = origin_landmark();
  return project_landmark(
      simulated_camera(), scales(), T_camera_world(distance, angle_deg), landmark, kRadius);
}

TEST(ProjectLandmark, PutsItAtItsPixelAndInverseDepth) {
  Landmark landmark = origin_landmark();
  landmark.p_world = {0.3, -0.2, 0};
  const std::optional<Projection> seen =
      project_landmark(simulated_camera(), scales(), T_camera_world(4, 0), landmark, kRadius);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->px.x(), 525.0 * 0.3 / 4 + 319.5, 1e-4);
  EXPECT_NEAR(seen->px.y(), 520.0 * -0.2 / 4 + 241.0, 1e-4);
  EXPECT_NEAR(seen->inverse_depth, 0.25, 1e-7);
  EXPECT_EQ(seen->descriptor, &landmark.descriptor);
}

TEST(ProjectLandmark, PredictsTheLevelFromTheDistance) {
  // Level l is where 4 m / distance is 1.2^l; between two levels the coarser one.
  const std::vector<std::pair<double, int>> cases = {
      {4.4, 0}, {4.0, 0}, {3.9, 1}, {4.0 / 1.2, 1}, {3.2, 2}, {4.0 / 1.44, 2}, {2.7, 3}, {2.0, 3}};
  for (const auto& [distance, level] : cases) {
    const std::optional<Projection> seen = project(distance, 20);
    ASSERT_TRUE(seen) << distance;
    EXPECT_EQ(seen->min_level, level - 1) << distance;
    EXPECT_EQ(seen->max_level, level + 1) << distance;
    EXPECT_NEAR(seen->radius_px, kRadius * std::pow(1.2, level), 1e-4) << distance;
  }
}

TEST(ProjectLandmark, SearchesLessWhenSeenHeadOn) {
  EXPECT_NEAR(project(4, 3.0)->radius_px, 0.625 * kRadius, 1e-5);  // cos = 0.9986
  EXPECT_NEAR(project(4, 4.0)->radius_px, kRadius, 1e-5);          // cos = 0.9976
}

TEST(ProjectLandmark, RejectsWhatThePyramidCannotShow) {
  EXPECT_TRUE(project(4.0 * 1.19, 0));
  EXPECT_FALSE(project(4.0 * 1.21, 0));
  EXPECT_TRUE(project(4.0 / 1.728 * 0.81, 0));
  EXPECT_FALSE(project(4.0 / 1.728 * 0.79, 0));
}

TEST(ProjectLandmark, RejectsViewsMoreThan60DegreesOff) {
  EXPECT_TRUE(project(3, 59));
  EXPECT_TRUE(project(3, -59));
  EXPECT_FALSE(project(3, 61));
  EXPECT_FALSE(project(3, 180));
}

TEST(ProjectLandmark, RejectsWhatIsOutOfView) {
  const CameraModel camera = simulated_camera();
  Landmark landmark = origin_landmark();
  landmark.p_world.x() = (639.9 - 319.5) / 525.0 * 3;
  EXPECT_TRUE(project_landmark(camera, scales(), T_camera_world(3, 0), landmark, kRadius));
  landmark.p_world.x() = (640.1 - 319.5) / 525.0 * 3;
  EXPECT_FALSE(project_landmark(camera, scales(), T_camera_world(3, 0), landmark, kRadius));
  EXPECT_FALSE(in_view(camera, {0, 0, -1}));
  EXPECT_FALSE(in_view(camera, {0, 0, 0.04}));
  EXPECT_TRUE(in_view(camera, {0, 0, 0.06}));
  EXPECT_FALSE(in_view(camera, {0, -241.1 / 520.0, 1}));
}

TEST(InView, OfAWideLensIsWhatItShows) {
  CameraModel fisheye{"fisheye", 640, 480, 200, 200, 320, 240};
  fisheye.lens = LensModel::kFisheye;
  const auto at = [](double angle_deg) {
    const double angle = angle_deg * std::numbers::pi / 180;
    return Eigen::Vector3d(std::sin(angle), 0, std::cos(angle));
  };
  EXPECT_TRUE(in_view(fisheye, at(60)));  // at 200 * 1.047 = 209 px from the middle
  EXPECT_TRUE(in_view(fisheye, at(-69)));
  EXPECT_FALSE(in_view(fisheye, at(71)));  // it has no features there
  fisheye.width_px = 400;
  fisheye.cx = 200;
  EXPECT_FALSE(in_view(fisheye, at(60)));
  // r (1 - 0.3 r^2) / (1 + 1e-9 r^2) is 0 again at r = 1.83.
  CameraModel folding{"folding", 640, 480, 300, 300, 320, 240};
  folding.k1 = -0.3;
  folding.k4 = 1e-9;
  EXPECT_TRUE(in_view(folding, {0.5, 0, 1}));
  EXPECT_FALSE(in_view(folding, {1.83, 0, 1}));
}

}  // namespace
}  // namespace stillmap
