// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/gait.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "simulation/scene/person_shape.hpp"

namespace stillmap {
namespace {

using Eigen::Vector3d;

FloorPath there_and_round() {
  return FloorPath({{1.0, 0.0, 0.0, 0.0},
                    {2.0, 0.8, 0.0},
                    {3.0, 1.8, 0.4},
                    {4.0, 2.2, 1.4},
                    {5.0, 2.2, 2.0, 1.6}});
}

// The ball of the foot and the heel, in the world.
std::array<Vector3d, 2> contacts(const Footfalls::Foot& foot) {
  return {foot.T_world_sole * Vector3d(0.135, 0, 0), foot.T_world_sole * Vector3d(-0.045, 0, 0)};
}

TEST(Footfalls, AFootThatBearsDoesNotSlip) {
  const Footfalls feet(there_and_round(), {{1.0, 5.0}}, 0.09);
  for (const BodySide side : {BodySide::kLeft, BodySide::kRight}) {
    std::array<Vector3d, 2> before = contacts(feet.at(0.0, side));
    std::array<double, 2> slip{};
    for (double t = 0.002; t < 6.0; t += 0.002) {
      const Footfalls::Foot foot = feet.at(t, side);
      const std::array<Vector3d, 2> now = contacts(foot);
      for (std::size_t i = 0; i < 2; ++i) {
        const bool bears = foot.lift_m == 0.0 && now[i].z() < 0.004;
        slip[i] = bears ? slip[i] + (now[i] - before[i]).head<2>().norm() : 0.0;
        EXPECT_LT(slip[i], 0.02) << t;
      }
      before = now;
    }
  }
}

TEST(Footfalls, OneFootBearsAtAllTimesAndTheFeetEndSideBySide) {
  const Footfalls feet(there_and_round(), {{1.0, 5.0}}, 0.09);
  int steps = 0;
  bool lifted = false;
  for (double t = 0.0; t < 6.0; t += 0.01) {
    const bool left = feet.at(t, BodySide::kLeft).lift_m > 0;
    const bool right = feet.at(t, BodySide::kRight).lift_m > 0;
    EXPECT_FALSE(left && right) << t;
    steps += (left || right) && !lifted ? 1 : 0;
    lifted = left || right;
  }
  EXPECT_EQ(steps, 8);  // 4 s of 0.52 s
  const Vector3d between = feet.at(6.0, BodySide::kLeft).T_world_sole.translation() -
                           feet.at(6.0, BodySide::kRight).T_world_sole.translation();
  EXPECT_NEAR(between.norm(), 0.18, 1e-9);
  EXPECT_NEAR(between.dot(Vector3d(std::cos(1.6), std::sin(1.6), 0.0)), 0.0, 1e-9);
}

TEST(Pelvis, IsNoHigherThanTheLegsReachWhileWalking) {
  const Skeleton skeleton = person_skeleton(PersonLook{});
  const FloorPath path = there_and_round();
  const Footfalls feet(path, {{1.0, 5.0}}, 0.09);
  constexpr double kHeight = 0.96;
  double lowest = 1.0;
  double highest = 0.0;
  for (double t = 0.0; t < 6.0; t += 0.01) {
    const Stance stance{path.at(t), {feet.at(t, BodySide::kLeft), feet.at(t, BodySide::kRight)}};
    const Eigen::Isometry3d pelvis = pelvis_over(skeleton, kHeight, stance);
    for (std::size_t side = 0; side < 2; ++side) {
      const Vector3d hip =
          pelvis * rest_place(skeleton, side == 0 ? Joint::kLeftHip : Joint::kRightHip);
      const Vector3d ankle = ankle_of(skeleton, kHeight, stance.feet[side]).translation();
      EXPECT_LT((hip - ankle).norm(), leg_length(skeleton)) << t;
    }
    lowest = std::min(lowest, pelvis.translation().z());
    highest = std::max(highest, pelvis.translation().z());
  }
  EXPECT_GT(highest, kHeight - 0.03);
  EXPECT_GT(highest - lowest, 0.01);  // the pelvis moves up and down
  EXPECT_LT(highest - lowest, 0.12);
}

}  // namespace
}  // namespace stillmap
