// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/body.hpp"

#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "simulation/scene/person_shape.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector3f;

const Body& person() {
  static const Body body = [] {
    MaterialLibrary materials;
    return make_person(PersonLook{}, materials);
  }();
  return body;
}

Quaterniond about(const Vector3d& axis, double angle) {
  return Quaterniond(AngleAxisd(angle, axis));
}

std::size_t index(Joint joint) {
  return static_cast<std::size_t>(joint);
}

BodyPose some_pose() {
  BodyPose pose;
  pose.T_world_pelvis = Eigen::Translation3d(0.3, -2.0, 0.9) * AngleAxisd(1.1, Vector3d::UnitZ());
  for (std::size_t j = 1; j < kJoints; ++j) {
    const double a = 0.35 * std::sin(1.7 * double(j));
    pose.rotations[j] = about(Vector3d(1.0, 0.4 * double(j % 3), -0.2).normalized(), a);
  }
  return pose;
}

TEST(Body, AtRestItIsAsItWasMade) {
  const PosedSurface surface = person().posed(BodyPose{});
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    EXPECT_LT((surface.positions[i] - person().rest().positions[i]).norm(), 1e-6F);
    EXPECT_LT((surface.normals[i] - person().rest().normals[i]).norm(), 1e-5F);
  }
}

TEST(Body, MovesAsAWholeWithThePelvis) {
  BodyPose pose;
  pose.T_world_pelvis =
      Eigen::Translation3d(1.0, 2.0, 3.0) * AngleAxisd(0.6, Vector3d(1, 2, 2) / 3.0);
  const PosedSurface surface = person().posed(pose);
  const Eigen::Isometry3f T = pose.T_world_pelvis.cast<float>();
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    EXPECT_LT((surface.positions[i] - T * person().rest().positions[i]).norm(), 1e-5F);
  }
}

// The hand's position computed joint by joint, without the body's code.
TEST(Body, JointsFollowTheirParents) {
  const BodyPose pose = some_pose();
  const auto& rest = person().skeleton().positions;
  const auto step = [&](Joint from, Joint to) {
    return Vector3d(rest[index(to)] - rest[index(from)]);
  };
  const auto turn = [&](Joint joint) { return pose.rotations[index(joint)]; };
  const Vector3d elbow = step(Joint::kLeftShoulder, Joint::kLeftElbow) +
                         turn(Joint::kLeftElbow) * step(Joint::kLeftElbow, Joint::kLeftWrist);
  const Vector3d shoulder =
      step(Joint::kChest, Joint::kLeftShoulder) + turn(Joint::kLeftShoulder) * elbow;
  const Vector3d chest = step(Joint::kSpine, Joint::kChest) + turn(Joint::kChest) * shoulder;
  const Vector3d spine = step(Joint::kPelvis, Joint::kSpine) + turn(Joint::kSpine) * chest;
  const Vector3d expected = pose.T_world_pelvis * spine;
  const auto joints = person().T_world_joints(pose);
  EXPECT_LT((joints[index(Joint::kLeftWrist)].translation() - expected).norm(), 1e-12);
}

// A bent limb must not move the other side, nor the trunk beside the arms.
TEST(Body, LimbsDoNotPullAtEachOther) {
  BodyPose pose;
  pose.rotations[index(Joint::kLeftHip)] = about(Vector3d::UnitY(), -1.2);
  pose.rotations[index(Joint::kLeftShoulder)] = about(Vector3d::UnitY(), -1.2);
  const PosedSurface surface = person().posed(pose);
  int moved = 0;
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const Vector3f& p = person().rest().positions[i];
    const float by = (surface.positions[i] - p).norm();
    moved += by > 0.1F ? 1 : 0;
    if (p.y() < -0.04F) {  // the right half
      EXPECT_LT(by, 0.005F) << p.transpose();
    }
    if (p.y() > 0.0F && p.y() < 0.10F && p.z() > 0.1F && p.z() < 0.3F) {
      EXPECT_LT(by, 0.02F) << p.transpose();  // the left flank
    }
  }
  EXPECT_GT(moved, 1000);
}

TEST(Body, HandsAndFeetFollowTheirBonesRigidly) {
  const BodyPose pose = some_pose();
  const PosedSurface surface = person().posed(pose);
  const auto joints = person().T_world_joints(pose);
  const auto& rest = person().skeleton().positions;
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const Vector3d p = person().rest().positions[i].cast<double>();
    const Vector3d from_wrist = p - rest[index(Joint::kRightWrist)];
    const bool fingers = p.y() < -0.3 && from_wrist.norm() < 0.2 && from_wrist.z() < -0.08;
    if (!fingers) continue;
    const Vector3d expected = joints[index(Joint::kRightWrist)] * from_wrist;
    EXPECT_LT((surface.positions[i].cast<double>() - expected).norm(), 0.004);
  }
}

TEST(Body, BendsWithoutTearing) {
  const PosedSurface surface = person().posed(some_pose());
  float longest = 0.F;
  for (const Mesh::Triangle& t : person().rest().triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      longest =
          std::max(longest, (surface.positions[t[i]] - surface.positions[t[(i + 1) % 3]]).norm());
    }
  }
  EXPECT_LT(longest, 0.07F);
  for (const Vector3f& n : surface.normals) EXPECT_NEAR(n.norm(), 1.F, 1e-4F);
}

TEST(Body, PosesInWellUnderAMillisecond) {
  const BodyPose pose = some_pose();
  double best_ms = 1e9;
  for (int i = 0; i < 20; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const PosedSurface surface = person().posed(pose);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    best_ms = std::min(best_ms, took.count());
    ASSERT_FALSE(surface.positions.empty());
  }
  RecordProperty("best_us", static_cast<int>(1000 * best_ms));
#ifdef NDEBUG
  EXPECT_LT(best_ms, 1.0);
#endif
}

TEST(Body, NeedsANormalForEachCorner) {
  Mesh mesh;
  mesh.positions.emplace_back(0, 0, 0);
  EXPECT_THROW(Body(mesh, person().skeleton()), InternalError);
}

}  // namespace
}  // namespace stillmap
