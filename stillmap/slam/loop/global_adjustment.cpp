// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/loop/global_adjustment.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include "stillmap/slam/map/covisibility.hpp"
#include "stillmap/slam/mapping/map_adjustment.hpp"

namespace stillmap {
namespace {

using Motions = std::map<KeyframeId, Eigen::Isometry3d>;  // T_new_old, in the submap

std::vector<KeyframeId> keyframes_in(const Map& map, SubmapId submap) {
  std::vector<KeyframeId> ids;
  for (const auto& [id, keyframe] : map.keyframes()) {
    if (keyframe.submap == submap) ids.push_back(id);
  }
  return ids;
}

// The motion of the corrected key frame that shares most landmarks with a key frame, else of the
// key frame before it.
Eigen::Isometry3d neighbours_motion(const Map& map, const Motions& motions, KeyframeId id) {
  for (const CovisibleKeyframe& other : covisible_keyframes(map, id)) {
    const auto known = motions.find(other.id);
    if (known != motions.end()) return known->second;
  }
  const auto after = motions.upper_bound(id);
  return after == motions.begin() ? Eigen::Isometry3d::Identity() : std::prev(after)->second;
}

Motions motions_of_keyframes(const Map& map, const GlobalCorrection& correction) {
  Motions motions;
  std::set<SubmapId> submaps;
  for (const auto& [id, T_world_camera] : correction.T_world_camera) {
    if (!map.has(id)) continue;  // the key frame was dropped since
    motions[id] = T_world_camera * map.keyframe(id).T_world_camera.inverse();
    submaps.insert(map.keyframe(id).submap);
  }
  for (const auto& [id, keyframe] : map.keyframes()) {
    if (!submaps.contains(keyframe.submap) || motions.contains(id)) continue;
    motions[id] = neighbours_motion(map, motions, id);
  }
  return motions;
}

}  // namespace

Map submap_window(const Map& map, SubmapId submap) {
  return map.window(keyframes_in(map, submap));
}

GlobalCorrection adjust_globally(Map window,
                                 const CameraModel& camera,
                                 const MeasurementModel& measure,
                                 const BundleConfig& config) {
  std::vector<KeyframeId> all;
  for (const auto& [id, keyframe] : window.keyframes()) all.push_back(id);
  const Map before = window;
  adjust_map(window, all, camera, measure, config);
  GlobalCorrection correction;
  for (const auto& [id, keyframe] : window.keyframes()) {
    correction.T_world_camera[id] = keyframe.T_world_camera;
  }
  for (const LandmarkId id : before.landmark_ids()) {
    const Landmark* after = window.find(id);
    if (after != nullptr) correction.positions.emplace_back(id, after->p_world);
    for (const Observation& o : before.landmark(id).observations) {
      const bool stays = after != nullptr &&
                         std::ranges::find(after->observations, o) != after->observations.end();
      if (!stays) correction.outliers.emplace_back(id, o.keyframe);
    }
  }
  return correction;
}

void apply_correction(Map& map, const GlobalCorrection& correction) {
  const Motions motions = motions_of_keyframes(map, correction);
  std::set<LandmarkId> corrected;
  for (const auto& [id, position] : correction.positions) {
    if (map.find(id) == nullptr) continue;
    map.set_position(id, position);
    corrected.insert(id);
  }
  for (const LandmarkId id : map.landmark_ids()) {
    if (corrected.contains(id)) continue;
    const Landmark& landmark = map.landmark(id);
    const KeyframeId made_by =
        map.has(landmark.created_by) ? landmark.created_by : landmark.observations.front().keyframe;
    const auto motion = motions.find(made_by);
    if (motion != motions.end()) map.set_position(id, motion->second * landmark.p_world);
  }
  for (const auto& [id, T_new_old] : motions) {
    map.set_pose(id, T_new_old * map.keyframe(id).T_world_camera);
  }
  for (const auto& [landmark_id, keyframe] : correction.outliers) {
    const Landmark* landmark = map.find(landmark_id);
    if (landmark != nullptr &&
        std::ranges::find(landmark->observations, keyframe, &Observation::keyframe) !=
            landmark->observations.end()) {
      map.remove_observation(landmark_id, keyframe);
    }
  }
  for (const LandmarkId id : map.landmark_ids()) map.refresh(id);
  (void)map.take_changes();
}

}  // namespace stillmap
