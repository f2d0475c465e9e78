// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/mapping/local_mapper.hpp"

#include <set>

#include "stillmap/slam/map/covisibility.hpp"
#include "stillmap/slam/mapping/landmark_fusion.hpp"
#include "stillmap/slam/mapping/map_adjustment.hpp"

namespace stillmap {
namespace {

// The landmarks that key frames observe, without repetition, in the order of ids.
std::vector<LandmarkId> landmarks_of(const Map& map, std::span<const KeyframeId> keyframes) {
  std::set<LandmarkId> seen;
  for (const KeyframeId id : keyframes) {
    for (const LandmarkId landmark : map.keyframe(id).landmarks) {
      if (landmark.valid()) seen.insert(landmark);
    }
  }
  return {seen.begin(), seen.end()};
}

void fuse_with_neighbors(Map& map,
                         const std::vector<KeyframeId>& core,
                         const CameraModel& camera,
                         const MeasurementModel& measure,
                         const LandmarkFusionConfig& config) {
  const KeyframeId newest = core.front();
  const std::span<const KeyframeId> neighbors = std::span(core).subspan(1);
  for (const KeyframeId neighbor : neighbors) {
    const std::vector<LandmarkId> own = landmarks_of(map, std::span(&newest, 1));
    fuse_landmarks(map, neighbor, own, camera, measure, config);
  }
  fuse_landmarks(map, newest, landmarks_of(map, neighbors), camera, measure, config);
  for (const LandmarkId id : landmarks_of(map, std::span(&newest, 1))) {
    if (map.find(id) != nullptr) map.refresh(id);
  }
}

}  // namespace

std::vector<KeyframeId> mapping_core(const Map& map,
                                     KeyframeId newest,
                                     const MappingConfig& config) {
  std::vector<KeyframeId> core = {newest};
  for (const CovisibleKeyframe& neighbor : covisible_keyframes(map, newest)) {
    if (std::ssize(core) >= config.window_keyframes) break;
    core.push_back(neighbor.id);
  }
  return core;
}

MappingResult map_locally(Map window,
                          const std::vector<KeyframeId>& core,
                          const CameraModel& camera,
                          const CameraTimes& times,
                          const MeasurementModel& measure,
                          const MappingConfig& config) {
  const KeyframeId newest = core.front();
  correct_times(window, core, camera, times);
  cull_young_landmarks(window, newest, config.culling);
  triangulate_landmarks(window, newest, camera, measure, config.creation);
  fuse_with_neighbors(window, core, camera, measure, config.fusion);
  adjust_map(window, core, camera, measure, config.bundle);
  const TimeEvidence evidence = time_evidence_of(window, core, camera, measure);
  cull_redundant_keyframes(window, core, newest, measure, config.culling);
  return {window.take_changes(), evidence};
}

}  // namespace stillmap
