// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/loop/essential_graph.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "stillmap/slam/map/covisibility.hpp"

namespace stillmap {
namespace {

// The standard deviations of an edge with 100 common landmarks; others scale with the square root
// of the number.
constexpr double kSigma_m = 0.01;
constexpr double kSigma_rad = 0.005;

// The sigmas of a loop do not include errors common to its matches. Measured on pairs of views with
// true poses: half of the errors are within 1 sigma, 95 % within about 6.
constexpr double kLoopFactor = 3.0;
constexpr double kMinLoopSigma_m = 0.005;
constexpr double kMinLoopSigma_rad = 0.002;

struct Pair {
  std::uint32_t from;
  std::uint32_t to;  // the later key frame
  int shared;
};

PoseGraphEdge loop_edge(std::uint32_t from, std::uint32_t to, const LoopEdge& loop) {
  return {from,
          to,
          loop.T_a_b,
          std::max(kLoopFactor * loop.sigma_m, kMinLoopSigma_m),
          std::max(kLoopFactor * loop.sigma_rad, kMinLoopSigma_rad)};
}

// Disjoint sets of connected key frames (union-find).
class Forest {
 public:
  explicit Forest(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Joins two sets. False if they were one already.
  bool join(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

std::uint32_t place_of(const std::vector<KeyframeId>& keyframes, KeyframeId id) {
  return static_cast<std::uint32_t>(std::ranges::lower_bound(keyframes, id) - keyframes.begin());
}

// All pairs with common landmarks, those with most first, ties by position.
std::vector<Pair> sharing_pairs(const Map& map, const std::vector<KeyframeId>& keyframes) {
  std::vector<Pair> pairs;
  for (std::uint32_t to = 0; to < keyframes.size(); ++to) {
    for (const CovisibleKeyframe& other : covisible_keyframes(map, keyframes[to])) {
      if (other.id < keyframes[to]) {
        pairs.push_back({place_of(keyframes, other.id), to, other.shared_landmarks});
      }
    }
  }
  std::ranges::sort(pairs, [](const Pair& l, const Pair& r) {
    return std::tuple(-l.shared, l.from, l.to) < std::tuple(-r.shared, r.from, r.to);
  });
  return pairs;
}

}  // namespace

EssentialGraph essential_graph(const Map& map,
                               SubmapId submap,
                               std::span<const LoopEdge> loops,
                               const EssentialGraphConfig& config) {
  EssentialGraph essential;
  PoseGraph& graph = essential.graph;
  for (const auto& [id, keyframe] : map.keyframes()) {
    if (keyframe.submap != submap) continue;
    essential.keyframes.push_back(id);
    graph.T_world.push_back(keyframe.T_world_camera);
    graph.held.push_back(graph.held.empty() ? 1 : 0);
  }
  const auto now = [&](const Pair& p) {
    const double factor = std::sqrt(100.0 / p.shared);
    return PoseGraphEdge{p.from,
                         p.to,
                         graph.T_world[p.from].inverse() * graph.T_world[p.to],
                         factor * kSigma_m,
                         factor * kSigma_rad};
  };
  Forest forest(graph.T_world.size());
  for (const Pair& pair : sharing_pairs(map, essential.keyframes)) {
    const bool in_tree = forest.join(pair.from, pair.to);
    if (in_tree || pair.shared >= config.min_shared) graph.edges.push_back(now(pair));
  }
  for (std::uint32_t to = 1; to < graph.T_world.size(); ++to) {
    if (forest.join(to - 1, to)) graph.edges.push_back(now({to - 1, to, 1}));
  }
  for (const LoopEdge& loop : loops) {
    const auto in_submap = [&](KeyframeId id) {
      return map.has(id) && map.keyframe(id).submap == submap;
    };
    if (!in_submap(loop.a) || !in_submap(loop.b)) continue;
    essential.loop_edges.push_back(static_cast<std::uint32_t>(graph.edges.size()));
    graph.edges.push_back(loop_edge(
        place_of(essential.keyframes, loop.a), place_of(essential.keyframes, loop.b), loop));
  }
  return essential;
}

void move_keyframes(Map& map, const std::map<KeyframeId, Eigen::Isometry3d>& T_world_keyframe) {
  std::map<KeyframeId, Eigen::Isometry3d> T_new_old;
  for (const auto& [id, T_new] : T_world_keyframe) {
    T_new_old[id] = T_new * map.keyframe(id).T_world_camera.inverse();
    map.set_pose(id, T_new);
  }
  for (const LandmarkId id : map.landmark_ids()) {
    const Landmark& landmark = map.landmark(id);
    const KeyframeId made_by =
        map.has(landmark.created_by) ? landmark.created_by : landmark.observations.front().keyframe;
    const auto moved = T_new_old.find(made_by);
    if (moved != T_new_old.end()) map.set_position(id, moved->second * landmark.p_world);
  }
  // Viewing directions and distances follow once all poses are final.
  for (const LandmarkId id : map.landmark_ids()) map.refresh(id);
}

}  // namespace stillmap
