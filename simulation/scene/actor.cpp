// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/actor.hpp"

#include <algorithm>
#include <cmath>

namespace stillmap {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// The seat's top is at 0.46; the pelvis joint is that much over it.
constexpr double kSeatedPelvisHeight_m = 0.575;
constexpr double kSeatedPitch = -0.10;
constexpr double kRiseLean = 0.75;  // forward lean while getting up
constexpr double kArmSwing = 0.75;  // radians a metre of stride
constexpr double kChestTwist = 0.22;

double wave(double t_s, double period_s, double phase) {
  return std::sin(2.0 * std::numbers::pi * (t_s / period_s + phase));
}

// The lowest corner at rest is the shoes' sole.
double height_over_floor(const Body& body) {
  float lowest = 0.F;
  for (const Eigen::Vector3f& p : body.rest().positions) lowest = std::min(lowest, p.z());
  return -static_cast<double>(lowest);
}

double role_time(const Role& role, double t_s) {
  if (!role.loop || t_s < role.loop->end_s) return t_s;
  return role.loop->start_s +
         std::fmod(t_s - role.loop->start_s, role.loop->end_s - role.loop->start_s);
}

Isometry3d blended(const Isometry3d& a, const Isometry3d& b, double share_b) {
  Isometry3d T = Isometry3d::Identity();
  T.translation() = (1.0 - share_b) * a.translation() + share_b * b.translation();
  T.linear() = Eigen::Quaterniond(a.linear())
                   .slerp(share_b, Eigen::Quaterniond(b.linear()))
                   .toRotationMatrix();
  return T;
}

}  // namespace

Actor::Actor(const Body& body, Role role)
    : body_(&body),
      role_(std::move(role)),
      pelvis_height_m_(height_over_floor(body)),
      feet_(role_.path, role_.walks, rest_place(body.skeleton(), Joint::kLeftHip).y() + 0.005) {}

TrunkPosture Actor::trunk(const Stance& stance, double role_s, double t_s) const {
  TrunkPosture trunk;
  const double seated = role_.seat ? role_.seat->seated.at(role_s) : 0.0;
  const double standing = 1.0 - seated;
  const double lean = role_.lean.at(role_s);
  const double shift = role_.liveliness;
  Isometry3d pelvis = pelvis_over(body_->skeleton(), pelvis_height_m_, stance);
  const Vector3d sway(0.008 * wave(t_s, 3.1, shift), 0.012 * wave(t_s, 4.3, 0.3 + shift), 0.0);
  pelvis = Eigen::Translation3d(standing * sway - role_.crouch_m.at(role_s) * Vector3d::UnitZ()) *
           pelvis * AngleAxisd(0.35 * lean, Vector3d::UnitY());
  if (role_.seat) {
    const Isometry3d sitting = role_.seat->pose.T_world(kSeatedPelvisHeight_m) *
                               AngleAxisd(kSeatedPitch, Vector3d::UnitY());
    pelvis = blended(pelvis, sitting, seated);
  }
  trunk.T_world_pelvis = pelvis;
  const double talks = role_.talks.at(role_s);
  trunk.lean = 0.65 * lean + kRiseLean * 4.0 * seated * standing + 0.04 * standing +
               0.05 * talks * wave(t_s, 5.9, shift) + 0.012 * wave(t_s, 3.7, shift);
  trunk.twist = kChestTwist * stride_of(stance) * standing + 0.12 * talks * wave(t_s, 7.3, shift);
  trunk.head_yaw = role_.head_yaw.at(role_s) + talks * 0.30 * wave(t_s, 5.3, shift) +
                   0.05 * wave(t_s, 2.9, shift);
  trunk.head_pitch = role_.head_pitch.at(role_s) + talks * 0.10 * wave(t_s, 1.9, shift);
  return trunk;
}

PalmGoal Actor::palm(
    const BodyPose& pose, BodySide side, double swing, double role_s, double t_s) const {
  PalmGoal goal{hanging_palm(*body_, pose, side, swing), 0.0};
  const auto go_to = [&](const Vector3d& p_world, double roll, double share) {
    goal.p_world += share * (p_world - goal.p_world);
    goal.roll += share * (roll - goal.roll);
  };
  const double y = side == BodySide::kLeft ? 1.0 : -1.0;
  if (role_.seat) {
    const double seated = role_.seat->seated.at(role_s);
    const Isometry3d seat = role_.seat->pose.T_world(kSeatedPelvisHeight_m);
    const Vector3d resting(
        0.30, 0.13 * y, role_.seat->hands_height_m[static_cast<std::size_t>(side)]);
    go_to(seat * resting, 1.2, seated);
    const double phase = role_.liveliness + (y > 0 ? 0.0 : 0.37);
    const double raised = 0.5 + 0.5 * wave(t_s, y > 0 ? 4.7 : 6.1, phase);
    const Vector3d gesture(0.33 + 0.06 * wave(t_s, 1.7, phase),
                           (0.21 + 0.05 * wave(t_s, 1.3, phase)) * y,
                           0.40 + 0.07 * wave(t_s, 1.1, phase));
    go_to(seat * gesture, 0.5, seated * role_.talks.at(role_s) * raised * raised);
  }
  for (const Grip& grip : role_.grips) {
    const Vector3d& palm_thing = grip.palms_thing[static_cast<std::size_t>(side)];
    go_to(grip.T_world_thing(role_s) * palm_thing, grip.roll, grip.holds.at(role_s));
  }
  return goal;
}

BodyPose Actor::at(double t_s) const {
  const double role_s = role_time(role_, t_s);
  const Stance stance{role_.path.at(role_s),
                      {feet_.at(role_s, BodySide::kLeft), feet_.at(role_s, BodySide::kRight)}};
  BodyPose pose = pose_of_trunk(trunk(stance, role_s, t_s));
  for (const BodySide side : {BodySide::kLeft, BodySide::kRight}) {
    const bool left = side == BodySide::kLeft;
    const Footfalls::Foot& foot = stance.feet[static_cast<std::size_t>(side)];
    pose = with_leg(*body_, pose, side, ankle_of(body_->skeleton(), pelvis_height_m_, foot));
    const double swing = (left ? -1.0 : 1.0) * kArmSwing * stride_of(stance);
    pose = with_arm(*body_, pose, side, palm(pose, side, swing, role_s, t_s));
  }
  return pose;
}

}  // namespace stillmap
