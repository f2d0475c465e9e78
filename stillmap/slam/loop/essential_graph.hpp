// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <vector>

#include "stillmap/slam/loop/loop_match.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/optim/pose_graph.hpp"

namespace stillmap {

struct EssentialGraphConfig {
  int min_shared = 100;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_shared",
          self.min_shared,
          FieldInfo{
              "landmarks in common that tie two key frames when a loop is closed", "", 1, 100000});
  }
};

/// The key frames of a submap as a pose graph.
struct EssentialGraph {
  std::vector<KeyframeId> keyframes;  ///< per pose, by id; the first is held
  PoseGraph graph;
  std::vector<std::uint32_t> loop_edges;  ///< indices of the loops' edges, in their order
};

/// The edges: a spanning tree along the most shared landmarks, all pairs that share `min_shared` or
/// more, both as the poses are now; and the loops as they were measured, for key frames that are in
/// that submap. Where nothing is shared with earlier key frames, the one before is the neighbour.
///
/// To be made before the landmarks of both ends of a new loop are merged (else the ends would hold
/// each other where they are), with all earlier loops.
[[nodiscard]] EssentialGraph essential_graph(const Map& map,
                                             SubmapId submap,
                                             std::span<const LoopEdge> loops,
                                             const EssentialGraphConfig& config);

/// Moves the key frames there, and each landmark with the key frame that made it (where that is
/// gone, with the first that sees it).
void move_keyframes(Map& map, const std::map<KeyframeId, Eigen::Isometry3d>& T_world_keyframe);

}  // namespace stillmap
