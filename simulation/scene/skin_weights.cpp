// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/skin_weights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace stillmap {
namespace {

using Joints = std::array<Eigen::Vector3f, kJoints>;

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

// The width of the transition between bones: influence falls by e for each such distance that a
// corner is farther from a bone than from its nearest.
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
  return kJointParents[a] == b || kJointParents[b] == a;
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

// The scale of a body against 1.75 m, from the heights of head and ankle.
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
    bones.push_back({kJointParents[j], joints[kJointParents[j]], joints[j]});
    has_child[kJointParents[j]] = true;
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
      const Eigen::Vector3f along = (joints[j] - joints[kJointParents[j]]).normalized();
      bones.push_back({j, joints[j], joints[j] + 0.16F * scale * along});
    }
  }
  return bones;
}

// From the flesh about each joint's bones.
JointWeights distances_at(const Eigen::Vector3f& p, const std::vector<Bone>& bones, float scale) {
  JointWeights distances;
  distances.fill(std::numeric_limits<float>::max());
  for (const Bone& bone : bones) {
    const float d = distance_to_segment(p, bone) - kRadii[bone.joint] * scale;
    distances[bone.joint] = std::min(distances[bone.joint], d);
  }
  return distances;
}

std::size_t nearest_of(const JointWeights& distances) {
  return static_cast<std::size_t>(std::min_element(distances.begin(), distances.end()) -
                                  distances.begin());
}

// Only the nearest bone and its neighbours in the skeleton have influence, so that legs do not pull
// at each other, nor arms at the hips beside them.
JointWeights weights_of(const JointWeights& distances, float scale) {
  const std::size_t nearest = nearest_of(distances);
  JointWeights weights{};
  for (std::size_t j = 0; j < kJoints; ++j) {
    if (j != nearest && !is_neighbour(j, nearest)) continue;
    // The joint between the two: whichever is the child.
    const std::size_t child = j != nearest && kJointParents[j] == nearest ? j : nearest;
    weights[j] = std::exp((distances[nearest] - distances[j]) / (kSoftness[child] * scale));
  }
  return weights;
}

void normalize(JointWeights& weights) {
  float sum = 0.F;
  for (const float w : weights) sum += w;
  for (float& w : weights) w /= sum;
}

// A net in which all corners at one position are one knot.
struct Net {
  std::vector<std::uint32_t> knots;                    // of each corner
  std::vector<std::uint32_t> corners;                  // one of each knot
  std::vector<std::vector<std::uint32_t>> neighbours;  // of each knot, ascending
};

Net net_of(const Mesh& mesh) {
  Net net;
  std::map<std::array<float, 3>, std::uint32_t> places;
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
    const Eigen::Vector3f& p = mesh.positions[i];
    const auto [place, is_new] =
        places.try_emplace({p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(net.corners.size()));
    if (is_new) net.corners.push_back(i);
    net.knots.push_back(place->second);
  }
  net.neighbours.resize(net.corners.size());
  for (const Mesh::Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = net.knots[t[i]], b = net.knots[t[(i + 1) % 3]];
      net.neighbours[a].push_back(b);
      net.neighbours[b].push_back(a);
    }
  }
  for (std::vector<std::uint32_t>& around : net.neighbours) {
    std::ranges::sort(around);
    around.erase(std::unique(around.begin(), around.end()), around.end());
  }
  return net;
}

// The knots connected to `start` by steps that `passes` allows.
template <typename Passes>
std::vector<std::uint32_t> connected(const Net& net,
                                     std::uint32_t start,
                                     std::vector<bool>& seen,
                                     const Passes& passes) {
  std::vector<std::uint32_t> patch{start};
  seen[start] = true;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    for (const std::uint32_t next : net.neighbours[patch[i]]) {
      if (seen[next] || !passes(patch[i], next)) continue;
      seen[next] = true;
      patch.push_back(next);
    }
  }
  return patch;
}

using Labels = std::vector<std::size_t>;  // the nearest joint of each knot

// The largest patch of one of the wanted labels in a piece of the surface.
template <typename Wanted>
std::vector<std::uint32_t> greatest_patch(const Net& net,
                                          const Labels& labels,
                                          const std::vector<std::uint32_t>& piece,
                                          const Wanted& wanted) {
  std::vector<bool> seen(labels.size(), false);
  std::vector<std::uint32_t> greatest;
  for (const std::uint32_t knot : piece) {
    if (seen[knot] || !wanted(labels[knot])) continue;
    std::vector<std::uint32_t> patch =
        connected(net, knot, seen, [&](auto a, auto b) { return labels[a] == labels[b]; });
    if (patch.size() > greatest.size()) greatest = std::move(patch);
  }
  return greatest;
}

// Moved by an elbow or a wrist.
constexpr bool is_of_forearm(std::size_t joint) {
  return (joint >= static_cast<std::size_t>(Joint::kLeftElbow) &&
          joint <= static_cast<std::size_t>(Joint::kLeftWrist)) ||
         (joint >= static_cast<std::size_t>(Joint::kRightElbow) &&
          joint <= static_cast<std::size_t>(Joint::kRightWrist));
}

// A knot whose label is certainly right: on the hand if it is a separate piece, as with sleeves,
// even if it touches a hip; else in the largest patch.
std::uint32_t root_of(const Mesh& mesh,
                      const Net& net,
                      const Labels& labels,
                      const std::vector<std::uint32_t>& piece) {
  constexpr float kLongestHand_m = 0.4F;
  Eigen::AlignedBox3f box;
  for (const std::uint32_t knot : piece) box.extend(mesh.positions[net.corners[knot]]);
  if (box.sizes().norm() < kLongestHand_m) {
    const std::vector<std::uint32_t> hand = greatest_patch(net, labels, piece, is_of_forearm);
    if (20 * hand.size() > piece.size()) return hand.front();
  }
  return greatest_patch(net, labels, piece, [](std::size_t) { return true; }).front();
}

constexpr bool is_of_trunk(std::size_t joint) {
  return joint <= static_cast<std::size_t>(Joint::kHead);
}

// Whether the flesh of two joints meets on a body: a limb's bones with the next, its root with the
// trunk about it. Large triangles may leave out a part of the trunk.
bool meet(std::size_t a, std::size_t b) {
  if (a == b || is_neighbour(a, b) || (is_of_trunk(a) && is_of_trunk(b))) return true;
  const auto pair = [&](Joint first, Joint second) {
    const std::size_t i = static_cast<std::size_t>(first), j = static_cast<std::size_t>(second);
    return (a == i && b == j) || (a == j && b == i);
  };
  return pair(Joint::kNeck, Joint::kLeftShoulder) || pair(Joint::kNeck, Joint::kRightShoulder) ||
         pair(Joint::kSpine, Joint::kLeftHip) || pair(Joint::kSpine, Joint::kRightHip) ||
         pair(Joint::kLeftHip, Joint::kRightHip);
}

// Knots that no path over neighbouring bones connects with the rest of their piece: the part of a
// hip under a hand is nearest to the hand.
std::vector<std::uint32_t> strays(const Mesh& mesh, const Net& net, const Labels& labels) {
  std::vector<bool> in_piece(labels.size(), false), reached(labels.size(), false);
  for (std::uint32_t start = 0; start < labels.size(); ++start) {
    if (in_piece[start]) continue;
    const std::vector<std::uint32_t> piece =
        connected(net, start, in_piece, [](auto, auto) { return true; });
    const std::uint32_t root = root_of(mesh, net, labels, piece);
    connected(net, root, reached, [&](auto a, auto b) { return meet(labels[a], labels[b]); });
  }
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < labels.size(); ++i) {
    if (!reached[i]) found.push_back(i);
  }
  return found;
}

// Moves each knot's weights halfway to the mean of its neighbours'.
void smooth(const Net& net, std::vector<JointWeights>& weights) {
  const std::vector<JointWeights> before = weights;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (net.neighbours[i].empty()) continue;
    const float share = 0.5F / static_cast<float>(net.neighbours[i].size());
    for (float& w : weights[i]) w *= 0.5F;
    for (const std::uint32_t other : net.neighbours[i]) {
      for (std::size_t j = 0; j < kJoints; ++j) weights[i][j] += share * before[other][j];
    }
  }
}

}  // namespace

std::vector<JointWeights> weights_by_distance(const Mesh& rest, const Skeleton& skeleton) {
  const Joints joints = rest_joints(skeleton);
  const std::vector<Bone> bones = bones_of(joints);
  const float scale = body_scale(joints);
  std::vector<JointWeights> weights;
  weights.reserve(rest.positions.size());
  for (const Eigen::Vector3f& p : rest.positions) {
    weights.push_back(weights_of(distances_at(p, bones, scale), scale));
    normalize(weights.back());
  }
  return weights;
}

std::vector<JointWeights> weights_along_surface(const Mesh& rest, const Skeleton& skeleton) {
  constexpr int kRelabels = 12, kSmoothings = 4;
  const Joints joints = rest_joints(skeleton);
  const std::vector<Bone> bones = bones_of(joints);
  const float scale = body_scale(joints);
  const Net net = net_of(rest);
  std::vector<JointWeights> distances;
  Labels labels;
  for (const std::uint32_t corner : net.corners) {
    distances.push_back(distances_at(rest.positions[corner], bones, scale));
    labels.push_back(nearest_of(distances.back()));
  }
  for (int round = 0; round < kRelabels; ++round) {
    const std::vector<std::uint32_t> stray = strays(rest, net, labels);
    if (stray.empty()) break;
    for (const std::uint32_t knot : stray) {
      distances[knot][labels[knot]] = std::numeric_limits<float>::max();
      labels[knot] = nearest_of(distances[knot]);
    }
  }
  std::vector<JointWeights> of_knots;
  for (const JointWeights& d : distances) {
    of_knots.push_back(weights_of(d, scale));
    normalize(of_knots.back());
  }
  for (int i = 0; i < kSmoothings; ++i) smooth(net, of_knots);
  std::vector<JointWeights> weights;
  for (const std::uint32_t knot : net.knots) weights.push_back(of_knots[knot]);
  return weights;
}

}  // namespace stillmap
