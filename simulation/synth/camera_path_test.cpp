// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/camera_path.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "simulation/scene/office.hpp"
#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr std::array<PathKind, 5> kAll{
    PathKind::kXyz, PathKind::kRpy, PathKind::kHalfsphere, PathKind::kStatic, PathKind::kLoop};

struct Motion {
  double mean_speed = 0, max_speed = 0, max_acceleration = 0;           // m/s, m/s^2
  double mean_turn_deg = 0, max_turn_deg = 0, max_turn_change_deg = 0;  // deg/s, deg/s^2
};

// By differences over a minute of the path.
Motion motion_of(PathKind kind) {
  constexpr double kStep = 0.005;
  constexpr int kSteps = 12000;
  Motion m;
  Eigen::Vector3d last_velocity = Eigen::Vector3d::Zero(), last_turn = Eigen::Vector3d::Zero();
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Isometry3d a = T_world_camera(kind, i * kStep);
    const Eigen::Isometry3d b = T_world_camera(kind, (i + 1) * kStep);
    const Eigen::Vector3d velocity = (b.translation() - a.translation()) / kStep;
    const Eigen::Vector3d turn =
        so3_log(Eigen::Quaterniond(b.linear() * a.linear().transpose())) / kStep * kDegrees;
    m.mean_speed += velocity.norm() / kSteps;
    m.mean_turn_deg += turn.norm() / kSteps;
    m.max_speed = std::max(m.max_speed, velocity.norm());
    m.max_turn_deg = std::max(m.max_turn_deg, turn.norm());
    if (i > 0) {
      m.max_acceleration = std::max(m.max_acceleration, (velocity - last_velocity).norm() / kStep);
      m.max_turn_change_deg = std::max(m.max_turn_change_deg, (turn - last_turn).norm() / kStep);
    }
    last_velocity = velocity;
    last_turn = turn;
  }
  return m;
}

TEST(CameraPath, IsSmooth) {
  for (const PathKind kind : kAll) {
    const Motion m = motion_of(kind);
    EXPECT_LT(m.max_speed, 0.5) << static_cast<int>(kind);
    EXPECT_LT(m.max_acceleration, 0.6) << static_cast<int>(kind);
    EXPECT_LT(m.max_turn_deg, 30.0) << static_cast<int>(kind);
    EXPECT_LT(m.max_turn_change_deg, 30.0) << static_cast<int>(kind);
  }
}

TEST(CameraPath, HasTheSpeedsOfItsKind) {
  const Motion xyz = motion_of(PathKind::kXyz);
  EXPECT_GT(xyz.mean_speed, 0.2);
  EXPECT_LT(xyz.mean_speed, 0.3);
  const Motion rpy = motion_of(PathKind::kRpy);
  EXPECT_GT(rpy.mean_turn_deg, 10.0);
  EXPECT_LT(rpy.mean_turn_deg, 20.0);
  EXPECT_LT(rpy.mean_speed, 0.06);
  const Motion halfsphere = motion_of(PathKind::kHalfsphere);
  EXPECT_GT(halfsphere.mean_speed, 0.15);
  EXPECT_LT(halfsphere.mean_speed, 0.3);
  const Motion loop = motion_of(PathKind::kLoop);
  EXPECT_GT(loop.mean_speed, 0.2);
  EXPECT_LT(loop.mean_speed, 0.3);
  EXPECT_GT(loop.mean_turn_deg, 10.0);
  EXPECT_LT(loop.mean_turn_deg, 20.0);
  EXPECT_LT(motion_of(PathKind::kStatic).mean_speed, 0.02);
}

TEST(CameraPath, LoopClosesAfterOneRound) {
  const Eigen::Isometry3d start = T_world_camera(PathKind::kLoop, 0.0);
  const Eigen::Isometry3d end = T_world_camera(PathKind::kLoop, loop_period_s());
  EXPECT_TRUE(start.isApprox(end, 1e-9));
  const Eigen::Isometry3d half = T_world_camera(PathKind::kLoop, 0.5 * loop_period_s());
  EXPECT_GT(rotation_angle(start.linear().transpose() * half.linear()), 2.5);
}

TEST(CameraPath, HoldsTheCameraUpright) {
  for (const PathKind kind : kAll) {
    for (int i = 0; i < 60; ++i) {
      const Eigen::Isometry3d T = T_world_camera(kind, i);
      EXPECT_TRUE((T.linear() * T.linear().transpose()).isIdentity(1e-12));
      EXPECT_GT(T.linear().determinant(), 0);
      EXPECT_LT(T.linear()(2, 1), -0.7) << "the camera's y axis should point down";
    }
  }
}

TEST(CameraPath, KeepsClearOfTheFurniture) {
  const World office = make_office(0);
  std::vector<Eigen::Vector3d> corners;
  for (const Thing& thing : office.things) {
    for (const Eigen::Vector3f& p : thing.mesh.positions) {
      corners.push_back(thing.T_world_thing * p.cast<double>());
    }
  }
  for (const PathKind kind : kAll) {
    for (double t = 0; t < 30; t += 0.5) {
      const Eigen::Vector3d p_world = T_world_camera(kind, t).translation();
      double nearest = 1e9;
      for (const Eigen::Vector3d& p : corners) nearest = std::min(nearest, (p - p_world).norm());
      EXPECT_GT(nearest, 0.3) << static_cast<int>(kind) << " at " << t;
    }
  }
}

}  // namespace
}  // namespace stillmap
