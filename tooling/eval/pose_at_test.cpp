// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/pose_at.hpp"

#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

StampedPose pose(double seconds, double x, double angle) {
  return {{seconds, ""}, make_pose(so3_exp({0, 0, angle}), Eigen::Vector3d(x, 0, 0))};
}

TEST(PoseAt, IsBetweenThePosesAround) {
  const Trajectory trajectory = {pose(1.00, 0, 0), pose(1.01, 1, 0.2), pose(1.50, 2, 0.4)};
  const Eigen::Isometry3d T = *pose_at(trajectory, 1.0025);
  EXPECT_NEAR(T.translation().x(), 0.25, 1e-9);
  EXPECT_NEAR(rotation_angle(T.linear()), 0.05, 1e-9);
  EXPECT_NEAR(pose_at(trajectory, 1.01)->translation().x(), 1.0, 1e-12);
  // 0.01 s after a pose and 0.48 s before the next.
  EXPECT_NEAR(pose_at(trajectory, 1.02)->translation().x(), 1.0 + 0.01 / 0.49, 1e-9);
}

TEST(PoseAt, IsTheLastOneShortlyAfterIt) {
  const Trajectory trajectory = {pose(1.00, 3, 0.1), pose(2.00, 5, 0.2)};
  EXPECT_NEAR(pose_at(trajectory, 0.99)->translation().x(), 3.0, 1e-12);
  EXPECT_NEAR(pose_at(trajectory, 2.01)->translation().x(), 5.0, 1e-12);
}

TEST(PoseAt, IsNotKnownFarFromAllPoses) {
  const Trajectory trajectory = {pose(1.00, 0, 0), pose(2.00, 1, 0)};
  EXPECT_FALSE(pose_at(trajectory, 0.97));
  EXPECT_FALSE(pose_at(trajectory, 1.5));
  EXPECT_FALSE(pose_at(trajectory, 2.03));
  EXPECT_FALSE(pose_at({}, 1.0));
}

}  // namespace
}  // namespace stillmap
