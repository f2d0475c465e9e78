// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "simulation/scene/mesh.hpp"

namespace stillmap {

/// Joints of a body, parents before children. Left is the person's own left.
enum class Joint : std::uint8_t {
  kPelvis,
  kSpine,
  kChest,
  kNeck,
  kHead,
  kLeftShoulder,
  kLeftElbow,
  kLeftWrist,
  kRightShoulder,
  kRightElbow,
  kRightWrist,
  kLeftHip,
  kLeftKnee,
  kLeftAnkle,
  kRightHip,
  kRightKnee,
  kRightAnkle,
};
inline constexpr std::size_t kJoints = 17;

/// How somebody stands, sits or walks. Body axes at rest: x forward, y left, z up.
struct BodyPose {
  Eigen::Isometry3d T_world_pelvis = Eigen::Isometry3d::Identity();
  /// Rotation of each joint against its parent, identity at rest; that of kPelvis is not used.
  std::array<Eigen::Quaterniond, kJoints> rotations = [] {
    std::array<Eigen::Quaterniond, kJoints> none;
    none.fill(Eigen::Quaterniond::Identity());
    return none;
  }();
};

/// Where the joints are at rest, in the frame of the pelvis joint; legs straight, arms down or
/// somewhat away from the body.
struct Skeleton {
  std::array<Eigen::Vector3d, kJoints> positions{};
};

/// The corners of a body's surface in one pose, in world axes.
struct PosedSurface {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
};

/// Whether a body's limbs touch others or the trunk at rest, as those of models of people may.
enum class Limbs : std::uint8_t { kApart, kTouching };

/// A person's surface, which bends smoothly at the joints (linear blend skinning).
class Body {
 public:
  /// `rest` is the surface at rest, in the frame of the pelvis joint. Each corner is bound to the
  /// bones near it, where limbs touch only to those that it hangs together with.
  Body(Mesh rest, const Skeleton& skeleton, Limbs limbs = Limbs::kApart);

  [[nodiscard]] const Mesh& rest() const { return rest_; }
  [[nodiscard]] const Skeleton& skeleton() const { return skeleton_; }

  /// The surface in a pose; corners in the order of rest().
  [[nodiscard]] PosedSurface posed(const BodyPose& pose) const;

  /// Where the joints are in a pose, and how they are turned.
  [[nodiscard]] std::array<Eigen::Isometry3d, kJoints> T_world_joints(const BodyPose& pose) const;

 private:
  /// The up to four bones that a corner follows, and how much each.
  struct Binding {
    std::array<std::uint8_t, 4> joints;
    std::array<float, 4> weights;  // sum 1
  };

  Mesh rest_;
  Skeleton skeleton_;
  std::vector<Binding> bindings_;
};

}  // namespace stillmap
