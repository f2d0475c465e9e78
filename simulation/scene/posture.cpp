// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/posture.hpp"

#include <algorithm>
#include <cmath>

namespace stillmap {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kPalmBeyondWrist_m = 0.07;

constexpr std::size_t index(Joint joint) {
  return static_cast<std::size_t>(joint);
}

Quaterniond turned(double angle, const Vector3d& axis) {
  return Quaterniond(AngleAxisd(angle, axis));
}

// Two bones in a row, as joints: hip, knee, ankle.
struct Limb {
  Joint root;
  Joint middle;
  Joint end;
  Joint parent;
};

Limb leg(BodySide side) {
  return side == BodySide::kLeft
             ? Limb{Joint::kLeftHip, Joint::kLeftKnee, Joint::kLeftAnkle, Joint::kPelvis}
             : Limb{Joint::kRightHip, Joint::kRightKnee, Joint::kRightAnkle, Joint::kPelvis};
}

Limb arm(BodySide side) {
  return side == BodySide::kLeft
             ? Limb{Joint::kLeftShoulder, Joint::kLeftElbow, Joint::kLeftWrist, Joint::kChest}
             : Limb{Joint::kRightShoulder, Joint::kRightElbow, Joint::kRightWrist, Joint::kChest};
}

// The middle of the palm at rest: on the forearm's line beyond the wrist.
Vector3d rest_palm(const Skeleton& skeleton, const Limb& limb) {
  const Vector3d& elbow = skeleton.positions[index(limb.middle)];
  const Vector3d& wrist = skeleton.positions[index(limb.end)];
  return wrist + kPalmBeyondWrist_m * (wrist - elbow).normalized();
}

// Axes of a bone: along it, and the hinge that it bends about.
Matrix3d bone_axes(const Vector3d& along, const Vector3d& hinge) {
  const Vector3d x = along.normalized();
  const Vector3d y = (hinge - hinge.dot(x) * x).normalized();
  Matrix3d axes;
  axes << x, y, x.cross(y);
  return axes;
}

// The directions, in world axes, of a limb's two bones that put its end at `target`.
struct JointBend {
  Vector3d upper;
  Vector3d lower;
  Vector3d hinge;
};

// `pole`: the direction in which the middle joint points.
JointBend bend_to(const Vector3d& from,
                  const Vector3d& target,
                  double upper,
                  double lower,
                  const Vector3d& pole) {
  const Vector3d along = (target - from).normalized();
  const double reach =
      std::clamp((target - from).norm(), 1.05 * std::abs(upper - lower), 0.9995 * (upper + lower));
  const Vector3d out = (pole - pole.dot(along) * along).normalized();
  const double x = (upper * upper - lower * lower + reach * reach) / (2.0 * reach);
  const double y = std::sqrt(std::max(upper * upper - x * x, 0.0));
  const Vector3d middle = x * along + y * out;
  return {middle, reach * along - middle, out.cross(along)};
}

// Turns the two bones of a limb from rest to a bend.
BodyPose with_bend(const Body& body,
                   BodyPose pose,
                   const Limb& limb,
                   const JointBend& bend,
                   const Vector3d& rest_pole) {
  const std::array<Isometry3d, kJoints> joints = body.T_world_joints(pose);
  const auto& rest = body.skeleton().positions;
  const Vector3d rest_upper = rest[index(limb.middle)] - rest[index(limb.root)];
  const Vector3d rest_lower = rest[index(limb.end)] - rest[index(limb.middle)];
  const Vector3d rest_hinge = rest_pole.cross(rest_upper);
  const Matrix3d world_upper =
      bone_axes(bend.upper, bend.hinge) * bone_axes(rest_upper, rest_hinge).transpose();
  const Matrix3d world_lower =
      bone_axes(bend.lower, bend.hinge) * bone_axes(rest_lower, rest_hinge).transpose();
  const Matrix3d world_parent = joints[index(limb.parent)].linear();
  pose.rotations[index(limb.root)] = Quaterniond(Matrix3d(world_parent.transpose() * world_upper));
  pose.rotations[index(limb.middle)] = Quaterniond(Matrix3d(world_upper.transpose() * world_lower));
  return pose;
}

}  // namespace

const Vector3d& rest_place(const Skeleton& skeleton, Joint joint) {
  return skeleton.positions[index(joint)];
}

BodyPose pose_of_trunk(const TrunkPosture& trunk) {
  BodyPose pose;
  pose.T_world_pelvis = trunk.T_world_pelvis;
  const Vector3d up = Vector3d::UnitZ();
  const Vector3d left = Vector3d::UnitY();
  pose.rotations[index(Joint::kSpine)] =
      turned(0.5 * trunk.lean, left) * turned(0.4 * trunk.twist, up);
  pose.rotations[index(Joint::kChest)] =
      turned(0.5 * trunk.lean, left) * turned(0.6 * trunk.twist, up);
  const double yaw = trunk.head_yaw - trunk.twist;
  const double pitch = trunk.head_pitch - 0.85 * trunk.lean;
  pose.rotations[index(Joint::kNeck)] = turned(0.4 * yaw, up) * turned(0.5 * pitch, left);
  pose.rotations[index(Joint::kHead)] = turned(0.6 * yaw, up) * turned(0.5 * pitch, left);
  return pose;
}

double leg_length(const Skeleton& skeleton) {
  const Limb limb = leg(BodySide::kLeft);
  const auto& rest = skeleton.positions;
  return (rest[index(limb.middle)] - rest[index(limb.root)]).norm() +
         (rest[index(limb.end)] - rest[index(limb.middle)]).norm();
}

double arm_length(const Skeleton& skeleton) {
  const Limb limb = arm(BodySide::kLeft);
  const auto& rest = skeleton.positions;
  return (rest[index(limb.middle)] - rest[index(limb.root)]).norm() +
         (rest_palm(skeleton, limb) - rest[index(limb.middle)]).norm();
}

BodyPose with_leg(const Body& body,
                  const BodyPose& pose,
                  BodySide side,
                  const Isometry3d& T_world_ankle) {
  const Limb limb = leg(side);
  const auto& rest = body.skeleton().positions;
  const std::array<Isometry3d, kJoints> joints = body.T_world_joints(pose);
  const Vector3d forward = pose.T_world_pelvis.linear().col(0) + T_world_ankle.linear().col(0);
  const JointBend bend = bend_to(joints[index(limb.root)].translation(),
                                 T_world_ankle.translation(),
                                 (rest[index(limb.middle)] - rest[index(limb.root)]).norm(),
                                 (rest[index(limb.end)] - rest[index(limb.middle)]).norm(),
                                 forward);
  BodyPose bent = with_bend(body, pose, limb, bend, Vector3d::UnitX());
  const Matrix3d shin = body.T_world_joints(bent)[index(limb.middle)].linear();
  bent.rotations[index(limb.end)] =
      Quaterniond(Matrix3d(shin.transpose() * T_world_ankle.linear()));
  return bent;
}

BodyPose with_arm(const Body& body, const BodyPose& pose, BodySide side, const PalmGoal& goal) {
  const Limb limb = arm(side);
  const auto& rest = body.skeleton().positions;
  const std::array<Isometry3d, kJoints> joints = body.T_world_joints(pose);
  const double y = side == BodySide::kLeft ? 1.0 : -1.0;
  const Vector3d back = joints[index(limb.parent)].linear() * Vector3d(-0.6, 0.45 * y, -0.35);
  const Vector3d palm = rest_palm(body.skeleton(), limb);
  const JointBend bend = bend_to(joints[index(limb.root)].translation(),
                                 goal.p_world,
                                 (rest[index(limb.middle)] - rest[index(limb.root)]).norm(),
                                 (palm - rest[index(limb.middle)]).norm(),
                                 back);
  BodyPose bent = with_bend(body, pose, limb, bend, -Vector3d::UnitX());
  const Vector3d forearm = (rest[index(limb.end)] - rest[index(limb.middle)]).normalized();
  // Half of the turn in the forearm, as its two bones do, half in the wrist.
  const Quaterniond half_roll = turned(0.5 * y * goal.roll, forearm);
  bent.rotations[index(limb.middle)] = bent.rotations[index(limb.middle)] * half_roll;
  bent.rotations[index(limb.end)] = half_roll;
  return bent;
}

Vector3d palm_place(const Body& body, const BodyPose& pose, BodySide side) {
  const Limb limb = arm(side);
  const Isometry3d T_world_wrist = body.T_world_joints(pose)[index(limb.end)];
  return T_world_wrist *
         (rest_palm(body.skeleton(), limb) - body.skeleton().positions[index(limb.end)]);
}

Vector3d hanging_palm(const Body& body, const BodyPose& pose, BodySide side, double swing) {
  const Limb limb = arm(side);
  const std::array<Isometry3d, kJoints> joints = body.T_world_joints(pose);
  const double y = side == BodySide::kLeft ? 1.0 : -1.0;
  // Arms hang straight down at any lean of the chest; the elbow is never fully stretched.
  const Vector3d flat = joints[index(limb.parent)].linear().col(0);
  const double yaw = std::atan2(flat.y(), flat.x());
  const double length = arm_length(body.skeleton());
  const Vector3d hang(0.06, 0.075 * y, -0.965 * length);
  const Quaterniond swung = turned(yaw, Vector3d::UnitZ()) * turned(-swing, Vector3d::UnitY());
  return joints[index(limb.root)].translation() + swung * hang;
}

}  // namespace stillmap
