// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/se3.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

TEST(Se3, ExpEqualsAngleAxis) {
  for (const double angle : {0.0, 1e-12, 1e-6, 0.1, 1.0, 3.0}) {
    const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 0.5).normalized();
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    EXPECT_TRUE(so3_exp(angle * axis).toRotationMatrix().isApprox(expected, 1e-14)) << angle;
  }
}

TEST(Se3, LogInvertsExp) {
  for (const double angle : {0.0, 1e-12, 1e-6, 0.1, 1.0, 3.1}) {
    const Eigen::Vector3d w = angle * Eigen::Vector3d(1, -2, 0.5).normalized();
    EXPECT_LT((so3_log(so3_exp(w)) - w).norm(), 1e-12) << angle;
  }
  // A quaternion and its negative are the same rotation.
  const Eigen::Quaterniond q = so3_exp({0.3, 0.1, 0.2});
  EXPECT_LT((so3_log(Eigen::Quaterniond(-q.coeffs())) - so3_log(q)).norm(), 1e-12);
}

TEST(Se3, RotationAngle) {
  EXPECT_NEAR(rotation_angle(Eigen::Matrix3d::Identity()), 0.0, 1e-12);
  const Eigen::Matrix3d half_turn =
      Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_NEAR(rotation_angle(half_turn), std::numbers::pi, 1e-7);
}

TEST(Se3, InterpolateMeetsItsEndsAndHalvesTheAngle) {
  const Eigen::Isometry3d a = make_pose(so3_exp({0.1, 0, 0}), {1, 0, 0});
  const Eigen::Isometry3d b = make_pose(so3_exp({0.1, 0.8, 0}), {3, 2, 0});
  EXPECT_TRUE(interpolate(a, b, 0).isApprox(a, 1e-12));
  EXPECT_TRUE(interpolate(a, b, 1).isApprox(b, 1e-12));
  const Eigen::Isometry3d middle = interpolate(a, b, 0.5);
  EXPECT_NEAR(rotation_angle(a.linear().transpose() * middle.linear()),
              0.5 * rotation_angle(a.linear().transpose() * b.linear()),
              1e-12);
  EXPECT_TRUE(middle.translation().isApprox(Eigen::Vector3d(2, 1, 0)));
}

}  // namespace
}  // namespace stillmap
