// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/camera_velocity.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

// Walks and turns at constant velocities: `velocity()` in the camera's axes at time 0.
Eigen::Isometry3d steady(double time_s) {
  return make_pose(so3_exp(time_s * Eigen::Vector3d(0.2, -0.4, 0.3)),
                   time_s * Eigen::Vector3d(0.4, -0.3, 0.5));
}
CameraVelocity steady_velocity() {
  return {{0.4, -0.3, 0.5}, {0.2, -0.4, 0.3}};
}

TEST(CameraVelocity, OfAPointIsItsNumericDerivative) {
  const Eigen::Vector3d p_world(0.3, -0.5, 2.0);
  constexpr double kStep = 1e-5;
  const Eigen::Vector3d numeric =
      (steady(kStep).inverse() * p_world - steady(-kStep).inverse() * p_world) / (2 * kStep);
  EXPECT_LT((steady_velocity().of_point(p_world) - numeric).norm(), 1e-8);
}

TEST(MeanVelocity, IsTheMotionOverItsTime) {
  const CameraVelocity v = mean_velocity(
      make_pose(so3_exp(Eigen::Vector3d(0, 0.1, 0)), Eigen::Vector3d(0.2, 0, -0.1)), 0.5);
  EXPECT_LT((v.linear - Eigen::Vector3d(0.4, 0, -0.2)).norm(), 1e-12);
  EXPECT_LT((v.angular - Eigen::Vector3d(0, 0.2, 0)).norm(), 1e-12);
  EXPECT_EQ(mean_velocity(steady(1), 0).linear.norm(), 0);
  EXPECT_EQ(mean_velocity(steady(1), -1).angular.norm(), 0);
}

TEST(FittedVelocity, IsThatOfASteadyMotionAndIgnoresTheOffset) {
  std::vector<TimedMotion> motions;
  const Eigen::Isometry3d offset = make_pose(Eigen::Quaterniond::Identity(), {0.01, 0, -0.02});
  for (const double t : {-0.05, -0.01, 0.0, 0.03}) motions.push_back({t, offset * steady(t)});
  const CameraVelocity v = fitted_velocity(motions);
  EXPECT_LT((v.linear - steady_velocity().linear).norm(), 1e-9);
  EXPECT_LT((v.angular - steady_velocity().angular).norm(), 1e-9);
}

TEST(FittedVelocity, HasAFifthOfTheNoiseOfTwoFrames) {
  // The standard deviation of the slope of a line through five values at distance 1 is 1 / sqrt(10)
  // of the values', that of a difference sqrt(2).
  std::vector<TimedMotion> motions;
  for (int k = -2; k <= 2; ++k) {
    motions.push_back(
        {k / 30.0, make_pose(Eigen::Quaterniond::Identity(), {k == 2 ? 1e-3 : 0, 0, 0})});
  }
  EXPECT_NEAR(fitted_velocity(motions).linear.x(), 0.2 * 1e-3 * 30, 1e-9);
}

TEST(FittedVelocity, IsZeroWithoutTime) {
  EXPECT_EQ(fitted_velocity({}).linear.norm(), 0);
  const std::vector<TimedMotion> one_time(3, TimedMotion{0.1, steady(0.1)});
  EXPECT_EQ(fitted_velocity(one_time).linear.norm(), 0);
}

}  // namespace
}  // namespace stillmap
