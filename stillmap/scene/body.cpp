// SPDX-License-Identifier: Apache-2.0
#include "stillmap/scene/body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

using Joints = std::array<Eigen::Vector3f, kJoints>;
using Weights = std::array<float, kJoints>;
using Matrix4x4f = Eigen::Matrix4f;

// The parent of each joint; the pelvis is its own.
constexpr std::array<std::size_t, kJoints> kParents = {
    0, 0, 1, 2, 3, 2, 5, 6, 2, 8, 9, 0, 11, 12, 0, 14, 15};

// The radius of the flesh about the bones that each joint moves, at 1.75 m of height.
constexpr std::array<float, kJoints> kRadii = {0.11F,
                                               0.12F,
                                               0.11F,
                                               0.055F,
                                               0.085F,
                                               0.05F,
                                               0.04F,
                                               0.035F,
                                               0.05F,
                                               0.04F,
                                               0.035F,
                                               0.08F,
                                               0.052F,
                                               0.04F,
                                               0.08F,
                                               0.052F,
                                               0.04F};

// How gradually the surface goes over from one bone to the next: influence falls by e for each
// such distance that a corner is farther from a bone than from its nearest.
constexpr std::array<float, kJoints> kSoftness = {0.030F,
                                                  0.030F,
                                                  0.030F,
                                                  0.020F,
                                                  0.015F,
                                                  0.014F,
                                                  0.012F,
                                                  0.008F,
                                                  0.014F,
                                                  0.012F,
                                                  0.008F,
                                                  0.020F,
                                                  0.015F,
                                                  0.010F,
                                                  0.020F,
                                                  0.015F,
                                                  0.010F};

struct Bone {
  std::size_t joint;
  Eigen::Vector3f from;
  Eigen::Vector3f to;
};

bool is_neighbour(std::size_t a, std::size_t b) {
  return kParents[a] == b || kParents[b] == a;
}

float distance_to_segment(const Eigen::Vector3f& p, const Bone& bone) {
  const Eigen::Vector3f along = bone.to - bone.from;
  const float length2 = along.squaredNorm();
  const float share =
      length2 > 0 ? std::clamp((p - bone.from).dot(along) / length2, 0.F, 1.F) : 0.F;
  return (bone.from + share * along - p).norm();
}

Joints rest_joints(const Skeleton& skeleton) {
  Joints joints;
  for (std::size_t j = 0; j < kJoints; ++j) joints[j] = skeleton.positions[j].cast<float>();
  return joints;
}

// How much bigger than 1.75 m a body is, from its head's and ankle's height.
float body_scale(const Joints& joints) {
  constexpr float kAnkleToHead = 1.47F;
  const float height =
      joints[std::size_t(Joint::kHead)].z() - joints[std::size_t(Joint::kLeftAnkle)].z();
  return std::max(height, 0.1F) / kAnkleToHead;
}

// From each joint to its children; heads, hands and feet go on where no joint is.
std::vector<Bone> bones_of(const Joints& joints) {
  std::vector<Bone> bones;
  std::array<bool, kJoints> has_child{};
  for (std::size_t j = 1; j < kJoints; ++j) {
    bones.push_back({kParents[j], joints[kParents[j]], joints[j]});
    has_child[kParents[j]] = true;
  }
  const float scale = body_scale(joints);
  for (std::size_t j = 0; j < kJoints; ++j) {
    if (has_child[j]) continue;
    const Joint joint = static_cast<Joint>(j);
    if (joint == Joint::kHead) {
      bones.push_back({j, joints[j], joints[j] + Eigen::Vector3f(0.02F, 0, 0.13F) * scale});
    } else if (joint == Joint::kLeftAnkle || joint == Joint::kRightAnkle) {
      bones.push_back({j, joints[j], joints[j] + Eigen::Vector3f(0.14F, 0, -0.05F) * scale});
    } else {
      const Eigen::Vector3f along = (joints[j] - joints[kParents[j]]).normalized();
      bones.push_back({j, joints[j], joints[j] + 0.16F * scale * along});
    }
  }
  return bones;
}

// Influence of the nearest bone and its neighbours in the skeleton; of nothing else, so that
// legs don't pull at each other nor arms at the hips that they hang beside.
Weights weights_at(const Eigen::Vector3f& p, const std::vector<Bone>& bones, float scale) {
  Weights distances;
  distances.fill(std::numeric_limits<float>::max());
  for (const Bone& bone : bones) {
    const float d = distance_to_segment(p, bone) - kRadii[bone.joint] * scale;
    distances[bone.joint] = std::min(distances[bone.joint], d);
  }
  const std::size_t nearest = static_cast<std::size_t>(
      std::min_element(distances.begin(), distances.end()) - distances.begin());
  Weights weights{};
  for (std::size_t j = 0; j < kJoints; ++j) {
    if (j != nearest && !is_neighbour(j, nearest)) continue;
    // The joint between the two: whichever is the child.
    const std::size_t child = j != nearest && kParents[j] == nearest ? j : nearest;
    weights[j] = std::exp((distances[nearest] - distances[j]) / (kSoftness[child] * scale));
  }
  return weights;
}

void normalize(Weights& weights) {
  float sum = 0.F;
  for (const float w : weights) sum += w;
  for (float& w : weights) w /= sum;
}

// The four greatest weights' joints, greatest first.
std::array<std::uint8_t, 4> strongest(const Weights& weights) {
  std::array<std::uint8_t, kJoints> order;
  for (std::size_t j = 0; j < kJoints; ++j) order[j] = static_cast<std::uint8_t>(j);
  std::partial_sort(order.begin(), order.begin() + 4, order.end(), [&](auto a, auto b) {
    return weights[a] != weights[b] ? weights[a] > weights[b] : a < b;
  });
  return {order[0], order[1], order[2], order[3]};
}

}  // namespace

Body::Body(Mesh rest, const Skeleton& skeleton) : rest_(std::move(rest)), skeleton_(skeleton) {
  STILLMAP_CHECK(rest_.normals.size() == rest_.positions.size());
  const Joints joints = rest_joints(skeleton_);
  const std::vector<Bone> bones = bones_of(joints);
  const float scale = body_scale(joints);
  std::vector<Weights> weights;
  weights.reserve(rest_.positions.size());
  for (const Eigen::Vector3f& p : rest_.positions) {
    weights.push_back(weights_at(p, bones, scale));
    normalize(weights.back());
  }
  bindings_.reserve(weights.size());
  for (const Weights& of_corner : weights) {
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
    const std::size_t parent = kParents[j];
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
