// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/body.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/scene/skin_weights.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

using Matrix4x4f = Eigen::Matrix4f;

// The four greatest weights' joints, greatest first.
std::array<std::uint8_t, 4> strongest(const JointWeights& weights) {
  std::array<std::uint8_t, kJoints> order;
  for (std::size_t j = 0; j < kJoints; ++j) order[j] = static_cast<std::uint8_t>(j);
  std::partial_sort(order.begin(), order.begin() + 4, order.end(), [&](auto a, auto b) {
    return weights[a] != weights[b] ? weights[a] > weights[b] : a < b;
  });
  return {order[0], order[1], order[2], order[3]};
}

}  // namespace

Body::Body(Mesh rest, const Skeleton& skeleton, Limbs limbs)
    : rest_(std::move(rest)), skeleton_(skeleton) {
  STILLMAP_CHECK(rest_.normals.size() == rest_.positions.size());
  const std::vector<JointWeights> weights = limbs == Limbs::kApart
                                                ? weights_by_distance(rest_, skeleton_)
                                                : weights_along_surface(rest_, skeleton_);
  bindings_.reserve(weights.size());
  for (const JointWeights& of_corner : weights) {
    Binding binding{strongest(of_corner), {}};
    float sum = 0.F;
    for (std::size_t i = 0; i < 4; ++i) sum += of_corner[binding.joints[i]];
    for (std::size_t i = 0; i < 4; ++i) {
      binding.weights[i] = of_corner[binding.joints[i]] / sum;
    }
    bindings_.push_back(binding);
  }
}

std::array<Eigen::Isometry3d, kJoints> Body::T_world_joints(const BodyPose& pose) const {
  std::array<Eigen::Isometry3d, kJoints> joints;
  joints[0] = pose.T_world_pelvis * Eigen::Translation3d(skeleton_.positions[0]);
  for (std::size_t j = 1; j < kJoints; ++j) {
    const std::size_t parent = kJointParents[j];
    joints[j] = joints[parent] *
                Eigen::Translation3d(skeleton_.positions[j] - skeleton_.positions[parent]) *
                pose.rotations[j];
  }
  return joints;
}

PosedSurface Body::posed(const BodyPose& pose) const {
  const std::array<Eigen::Isometry3d, kJoints> joints = T_world_joints(pose);
  std::array<Matrix4x4f, kJoints> motions;
  for (std::size_t j = 0; j < kJoints; ++j) {
    motions[j] = (joints[j] * Eigen::Translation3d(-skeleton_.positions[j])).matrix().cast<float>();
  }
  const std::size_t corners = rest_.positions.size();
  PosedSurface surface{std::vector<Eigen::Vector3f>(corners),
                       std::vector<Eigen::Vector3f>(corners)};
  for (std::size_t i = 0; i < corners; ++i) {
    const Binding& binding = bindings_[i];
    Matrix4x4f motion = binding.weights[0] * motions[binding.joints[0]];
    for (std::size_t k = 1; k < 4 && binding.weights[k] > 0.F; ++k) {
      motion.noalias() += binding.weights[k] * motions[binding.joints[k]];
    }
    const Eigen::Vector3f& p = rest_.positions[i];
    const Eigen::Vector3f& n = rest_.normals[i];
    const Eigen::Vector4f moved =
        motion.col(0) * p.x() + motion.col(1) * p.y() + motion.col(2) * p.z() + motion.col(3);
    const Eigen::Vector4f turned =
        motion.col(0) * n.x() + motion.col(1) * n.y() + motion.col(2) * n.z();
    surface.positions[i] = moved.head<3>();
    surface.normals[i] = turned.head<3>() / std::sqrt(turned.squaredNorm());
  }
  return surface;
}

}  // namespace stillmap
