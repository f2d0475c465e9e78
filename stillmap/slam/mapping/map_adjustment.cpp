// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/mapping/map_adjustment.hpp"

#include <set>

namespace stillmap {
namespace {

struct IndexedProblem {
  BundleProblem problem;
  std::vector<KeyframeId> keyframes;
  std::vector<LandmarkId> landmarks;
};

IndexedProblem make_problem(const Map& map,
                            const std::set<KeyframeId>& free,
                            const CameraModel& camera,
                            const MeasurementModel& measure) {
  IndexedProblem indexed;
  BundleProblem& problem = indexed.problem;
  problem.camera = camera;
  std::map<KeyframeId, std::uint32_t> camera_index;
  for (const auto& [id, keyframe] : map.keyframes()) {
    camera_index[id] = static_cast<std::uint32_t>(indexed.keyframes.size());
    indexed.keyframes.push_back(id);
    problem.T_camera_world.push_back(keyframe.T_world_camera.inverse());
    problem.held.push_back(free.contains(id) && !keyframe.is_origin ? 0 : 1);
  }
  for (const LandmarkId id : map.landmark_ids()) {
    const Landmark& landmark = map.landmark(id);
    bool moves = false;
    for (const Observation& o : landmark.observations) moves = moves || free.contains(o.keyframe);
    if (!moves) continue;
    const auto point = static_cast<std::uint32_t>(indexed.landmarks.size());
    indexed.landmarks.push_back(id);
    problem.points.push_back(landmark.p_world);
    for (const Observation& o : landmark.observations) {
      problem.observations.push_back({camera_index.at(o.keyframe),
                                      point,
                                      measure(*map.keyframe(o.keyframe).features, o.feature)});
    }
  }
  return indexed;
}

}  // namespace

void adjust_map(Map& map,
                std::span<const KeyframeId> free_keyframes,
                const CameraModel& camera,
                const MeasurementModel& measure,
                const BundleConfig& config) {
  const std::set<KeyframeId> free(free_keyframes.begin(), free_keyframes.end());
  const IndexedProblem indexed = make_problem(map, free, camera, measure);
  const BundleResult result = adjust_bundle(indexed.problem, config);

  for (std::size_t c = 0; c < indexed.keyframes.size(); ++c) {
    if (indexed.problem.held[c] == 0) {
      map.set_pose(indexed.keyframes[c], result.T_camera_world[c].inverse());
    }
  }
  for (std::size_t p = 0; p < indexed.landmarks.size(); ++p) {
    map.set_position(indexed.landmarks[p], result.points[p]);
  }
  for (std::size_t i = 0; i < result.inlier.size(); ++i) {
    if (result.inlier[i] != 0) continue;
    const BundleObservation& o = indexed.problem.observations[i];
    map.remove_observation(indexed.landmarks[o.point], indexed.keyframes[o.camera]);
  }
  for (const LandmarkId id : indexed.landmarks) {
    if (map.find(id) != nullptr) map.refresh(id);
  }
}

}  // namespace stillmap
