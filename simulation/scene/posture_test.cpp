// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/posture.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "simulation/scene/person_shape.hpp"

namespace stillmap {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

Body bare_body() {
  return Body(Mesh{}, person_skeleton(PersonLook{}));
}

TrunkPosture slanted_trunk() {
  TrunkPosture trunk;
  trunk.T_world_pelvis = Eigen::Translation3d(1.0, 2.0, 0.9) * AngleAxisd(0.7, Vector3d::UnitZ());
  trunk.lean = 0.3;
  trunk.twist = -0.2;
  return trunk;
}

TEST(Posture, ArmsReachTheirGoals) {
  const Body body = bare_body();
  const BodyPose pose = pose_of_trunk(slanted_trunk());
  for (const BodySide side : {BodySide::kLeft, BodySide::kRight}) {
    for (const Vector3d& goal_pelvis :
         {Vector3d(0.4, 0.1, 0.2), Vector3d(0.3, -0.1, 0.5), Vector3d(0.1, 0.0, 0.0)}) {
      const Vector3d goal = pose.T_world_pelvis * goal_pelvis;
      const BodyPose bent = with_arm(body, pose, side, {goal, 0.9});
      EXPECT_LT((palm_place(body, bent, side) - goal).norm(), 1e-6);
    }
  }
}

TEST(Posture, ArmsStretchTowardsWhatIsOutOfReach) {
  const Body body = bare_body();
  const BodyPose pose = pose_of_trunk(slanted_trunk());
  const Joint shoulder = Joint::kLeftShoulder;
  const Vector3d from = body.T_world_joints(pose)[std::size_t(shoulder)].translation();
  const Vector3d goal = from + Vector3d(3.0, 0.0, 0.0);
  const Vector3d palm =
      palm_place(body, with_arm(body, pose, BodySide::kLeft, {goal, 0.0}), BodySide::kLeft);
  EXPECT_NEAR((palm - from).norm(), arm_length(body.skeleton()), 0.002);
  EXPECT_NEAR((palm - from).normalized().x(), 1.0, 1e-9);
}

TEST(Posture, PalmsTurnedDownFaceTheFloor) {
  // A forearm that points forward: the palm faces inwards without a roll, downwards with one.
  const Body body = bare_body();
  const BodyPose pose = pose_of_trunk({});
  const Vector3d shoulder =
      body.T_world_joints(pose)[std::size_t(Joint::kLeftShoulder)].translation();
  const Vector3d goal = shoulder + Vector3d(0.33, 0.0, -0.27);
  const auto palm_normal = [&](double roll) {
    const BodyPose bent = with_arm(body, pose, BodySide::kLeft, {goal, roll});
    const Isometry3d wrist = body.T_world_joints(bent)[std::size_t(Joint::kLeftWrist)];
    // At rest the left palm faces right, level across the arm, which hangs 18 degrees outwards.
    return Vector3d(wrist.linear() * Vector3d(0.0, -std::cos(0.314), -std::sin(0.314)));
  };
  EXPECT_LT(palm_normal(0.0).y(), -0.8);
  EXPECT_LT(palm_normal(0.5 * M_PI).z(), -0.8);
}

TEST(Posture, AnklesGoWhereTheyAreWantedAndKneesForward) {
  const Body body = bare_body();
  TrunkPosture trunk;
  trunk.T_world_pelvis.translation().z() = 0.75;
  const BodyPose pose = pose_of_trunk(trunk);
  Isometry3d ankle = Isometry3d::Identity();
  ankle.translation() = Vector3d(0.15, 0.12, 0.08);
  ankle.linear() = AngleAxisd(0.3, Vector3d::UnitZ()).toRotationMatrix();
  const BodyPose bent = with_leg(body, pose, BodySide::kLeft, ankle);
  const auto joints = body.T_world_joints(bent);
  EXPECT_LT((joints[std::size_t(Joint::kLeftAnkle)].matrix() - ankle.matrix()).norm(), 1e-9);
  const Vector3d knee = joints[std::size_t(Joint::kLeftKnee)].translation();
  const Vector3d hip = joints[std::size_t(Joint::kLeftHip)].translation();
  EXPECT_GT(knee.x(), 0.5 * (hip.x() + 0.15) + 0.1);
  EXPECT_NEAR(
      (knee - hip).norm(),
      (rest_place(body.skeleton(), Joint::kLeftKnee) - rest_place(body.skeleton(), Joint::kLeftHip))
          .norm(),
      1e-9);
}

}  // namespace
}  // namespace stillmap
