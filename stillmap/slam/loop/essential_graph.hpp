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
              "number of common landmarks that makes two key frames an edge of the essential graph",
              "",
              1,
              100000});
  }
};

/// The key frames of a submap as a pose graph.
struct EssentialGraph {
  std::vector<KeyframeId> keyframes;  ///< per pose, by id; the first is held
  PoseGraph graph;
  std::vector<std::uint32_t> loop_edges;  ///< indices of the edges of the loops, in their order
};

/// Makes the essential graph of a submap. Its edges are a spanning tree along the most common
/// landmarks and all pairs with at least `min_shared` common landmarks, both with the present
/// relative poses, and the loops of the submap with their measured relative poses. A key frame
/// without landmarks in common with earlier ones is tied to the one before.
///
/// To be made with all earlier loops, before the landmarks of both ends of a new loop are merged:
/// common landmarks would tie the ends at their present poses.
[[nodiscard]] EssentialGraph essential_graph(const Map& map,
                                             SubmapId submap,
                                             std::span<const LoopEdge> loops,
                                             const EssentialGraphConfig& config);

/// Moves the key frames to the new poses, and each landmark with the key frame that created it (if
/// that is gone, with its first observer).
void move_keyframes(Map& map, const std::map<KeyframeId, Eigen::Isometry3d>& T_world_keyframe);

}  // namespace stillmap
