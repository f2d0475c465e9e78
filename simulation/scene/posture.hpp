// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "simulation/scene/body.hpp"

namespace stillmap {

enum class BodySide : std::uint8_t { kLeft, kRight };

/// The posture of trunk and head. Angles in radians; pitch forward and down, yaw and roll as of
/// a body that faces +x with z up: yaw to the left, roll to the right.
struct TrunkPosture {
  Eigen::Isometry3d T_world_pelvis = Eigen::Isometry3d::Identity();
  double lean = 0;   ///< pitch of the chest against the pelvis
  double twist = 0;  ///< yaw of the chest against the pelvis
  double head_yaw = 0;
  double head_pitch = 0;  ///< against the pelvis: a lean is evened out
};

/// A pose with that trunk, arms and legs as at rest.
[[nodiscard]] BodyPose pose_of_trunk(const TrunkPosture& trunk);

/// Length of a stretched leg, from hip to ankle, and of an arm, from shoulder to the palm's middle.
[[nodiscard]] double leg_length(const Skeleton& skeleton);
[[nodiscard]] double arm_length(const Skeleton& skeleton);

/// The joint's place at rest, in the frame of the pelvis joint.
[[nodiscard]] const Eigen::Vector3d& rest_place(const Skeleton& skeleton, Joint joint);

/// The same pose with a leg bent such that its ankle is as given, as far as the leg reaches.
/// The knee points where the pelvis and the foot face.
[[nodiscard]] BodyPose with_leg(const Body& body,
                                const BodyPose& pose,
                                BodySide side,
                                const Eigen::Isometry3d& T_world_ankle);

/// The goal of a palm.
struct PalmGoal {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  double roll = 0;  ///< turns the palm from inwards (0) to downwards (pi / 2)
};

/// The same pose with an arm bent such that the palm's middle is at the goal, as far as the arm
/// reaches; the elbow points back and out.
[[nodiscard]] BodyPose with_arm(const Body& body,
                                const BodyPose& pose,
                                BodySide side,
                                const PalmGoal& goal);

/// The position of the middle of a palm.
[[nodiscard]] Eigen::Vector3d palm_place(const Body& body, const BodyPose& pose, BodySide side);

/// The position of the palm of an arm that hangs from the shoulder, swung forward by an angle.
[[nodiscard]] Eigen::Vector3d hanging_palm(const Body& body,
                                           const BodyPose& pose,
                                           BodySide side,
                                           double swing);

}  // namespace stillmap
