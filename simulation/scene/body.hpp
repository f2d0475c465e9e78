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

/// The posture of a person. Body axes at rest: x forward, y left, z up.
struct BodyPose {
  Eigen::Isometry3d T_world_pelvis = Eigen::Isometry3d::Identity();
  /// Rotation of each joint against its parent, identity at rest; that of kPelvis is not used.
  std::array<Eigen::Quaterniond, kJoints> rotations = [] {
    std::array<Eigen::Quaterniond, kJoints> none;
    none.fill(Eigen::Quaterniond::Identity());
    return none;
  }();
};

/// The positions of the joints at rest, in the frame of the pelvis joint, with legs straight and
/// arms down or slightly away from the body.
struct Skeleton {
  std::array<Eigen::Vector3d, kJoints> positions{};
};

/// The vertices of a body's surface in one pose, in world coordinates.
struct PosedSurface {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
};

/// Whether the limbs of a body may touch each other or the trunk at rest, as in models of people.
enum class Limbs : std::uint8_t { kApart, kTouching };

/// A person's surface, which bends smoothly at the joints (linear blend skinning).
class Body {
 public:
  /// `rest` is the surface at rest, in the frame of the pelvis joint. Each vertex is bound to the
  /// bones near it; where limbs touch, only to bones to which it is connected along the surface.
  Body(Mesh rest, const Skeleton& skeleton, Limbs limbs = Limbs::kApart);

  [[nodiscard]] const Mesh& rest() const { return rest_; }
  [[nodiscard]] const Skeleton& skeleton() const { return skeleton_; }

  /// The surface in a pose, with vertices in the order of rest().
  [[nodiscard]] PosedSurface posed(const BodyPose& pose) const;

  /// The positions and orientations of the joints in a pose.
  [[nodiscard]] std::array<Eigen::Isometry3d, kJoints> T_world_joints(const BodyPose& pose) const;

 private:
  /// The up to four bones that a vertex follows, with their weights.
  struct Binding {
    std::array<std::uint8_t, 4> joints;
    std::array<float, 4> weights;  // sum 1
  };

  Mesh rest_;
  Skeleton skeleton_;
  std::vector<Binding> bindings_;
};

}  // namespace stillmap
