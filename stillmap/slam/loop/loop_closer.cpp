// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/loop/loop_closer.hpp"

#include <algorithm>
#include <set>

#include "stillmap/slam/map/covisibility.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kEndKeyframes = 10;  // of each end, whose landmarks are merged

// The later submap moves: what was there first stays where it is.
void join_submaps(Map& map, const LoopMatch& found) {
  const Keyframe& a = map.keyframe(found.edge.a);
  const Keyframe& b = map.keyframe(found.edge.b);
  const Eigen::Isometry3d T_a_b = a.T_world_camera * found.edge.T_a_b * b.T_world_camera.inverse();
  if (a.submap < b.submap) {
    map.join_submaps(b.submap, a.submap, T_a_b);
  } else {
    map.join_submaps(a.submap, b.submap, T_a_b.inverse());
  }
}

bool move_to_fit(Map& map, std::span<const LoopEdge> loops, const LoopConfig& config) {
  const SubmapId submap = map.keyframe(loops.back().b).submap;
  const EssentialGraph essential = essential_graph(map, submap, loops, config.essential);
  const PoseGraphResult fitted = optimize_pose_graph(essential.graph, config.pose_graph);
  if (fitted.chi2[essential.loop_edges.back()] > config.max_edge_chi2) return false;
  std::map<KeyframeId, Eigen::Isometry3d> T_world_keyframe;
  for (std::size_t i = 0; i < essential.keyframes.size(); ++i) {
    T_world_keyframe[essential.keyframes[i]] = fitted.T_world[i];
  }
  move_keyframes(map, T_world_keyframe);
  return true;
}

void merge_matches(Map& map, const LoopMatch& found) {
  for (const auto& [in_earlier, in_later] : found.matches) {
    const LandmarkId old = map.keyframe(found.edge.a).landmarks[in_earlier];
    const LandmarkId recent = map.keyframe(found.edge.b).landmarks[in_later];
    if (old == recent) continue;
    if (old.valid() && recent.valid()) {
      map.merge_landmarks(recent, old);
    } else if (old.valid()) {
      (void)map.add_observation(old, {found.edge.b, in_later});
    } else if (recent.valid()) {
      (void)map.add_observation(recent, {found.edge.a, in_earlier});
    }
  }
}

// A key frame and those that share most landmarks with it.
std::vector<KeyframeId> end_of_loop(const Map& map, KeyframeId id) {
  std::vector<KeyframeId> end = {id};
  for (const CovisibleKeyframe& other : covisible_keyframes(map, id)) {
    if (end.size() >= kEndKeyframes) break;
    end.push_back(other.id);
  }
  return end;
}

std::vector<LandmarkId> landmarks_seen(const Map& map, std::span<const KeyframeId> keyframes) {
  std::set<LandmarkId> seen;
  for (const KeyframeId id : keyframes) {
    std::ranges::copy_if(map.keyframe(id).landmarks,
                         std::inserter(seen, seen.end()),
                         [](LandmarkId landmark) { return landmark.valid(); });
  }
  return {seen.begin(), seen.end()};
}

void merge_ends(Map& map,
                const LoopMatch& found,
                const CameraModel& camera,
                const MeasurementModel& measure,
                const LandmarkFusionConfig& config) {
  // Before the matches join them, so that each is a neighbourhood of its own.
  const std::vector<KeyframeId> earlier = end_of_loop(map, found.edge.a);
  const std::vector<KeyframeId> later = end_of_loop(map, found.edge.b);
  merge_matches(map, found);
  const std::vector<LandmarkId> old = landmarks_seen(map, earlier);
  for (const KeyframeId id : later) fuse_landmarks(map, id, old, camera, measure, config);
  for (const KeyframeId id : earlier) {
    fuse_landmarks(map, id, landmarks_seen(map, later), camera, measure, config);
  }
  for (const std::vector<KeyframeId>& end : {earlier, later}) {
    for (const LandmarkId id : landmarks_seen(map, end)) map.refresh(id);
  }
}

}  // namespace

bool close_loop(Map& map,
                std::vector<LoopEdge>& loops,
                const LoopMatch& found,
                const CameraModel& camera,
                const MeasurementModel& measure,
                const LoopConfig& config) {
  const bool one_submap = map.keyframe(found.edge.a).submap == map.keyframe(found.edge.b).submap;
  loops.push_back(found.edge);
  if (!one_submap) {
    join_submaps(map, found);
  } else if (!move_to_fit(map, loops, config)) {
    loops.pop_back();
    return false;
  }
  merge_ends(map, found, camera, measure, config.fusion);
  (void)map.take_changes();  // of the whole map: nobody waits for them
  return true;
}

}  // namespace stillmap
