// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/mapping/map_problem.hpp"

#include <map>

namespace stillmap {

MapProblem make_problem(const Map& map,
                        const std::set<KeyframeId>& free,
                        const CameraModel& camera,
                        const MeasurementModel& measure) {
  MapProblem result;
  BundleProblem& problem = result.problem;
  problem.camera = camera;
  std::map<KeyframeId, std::uint32_t> camera_index;
  for (const auto& [id, keyframe] : map.keyframes()) {
    camera_index[id] = static_cast<std::uint32_t>(result.keyframes.size());
    result.keyframes.push_back(id);
    problem.T_camera_world.push_back(keyframe.T_world_camera.inverse());
    problem.held.push_back(free.contains(id) && !keyframe.is_origin ? 0 : 1);
  }
  for (const LandmarkId id : map.landmark_ids()) {
    const Landmark& landmark = map.landmark(id);
    bool moves = false;
    for (const Observation& o : landmark.observations) moves = moves || free.contains(o.keyframe);
    if (!moves) continue;
    const auto point = static_cast<std::uint32_t>(result.landmarks.size());
    result.landmarks.push_back(id);
    problem.points.push_back(landmark.p_world);
    for (const Observation& o : landmark.observations) {
      problem.observations.push_back({camera_index.at(o.keyframe),
                                      point,
                                      measure(*map.keyframe(o.keyframe).features, o.feature)});
      result.features.push_back(o.feature);
    }
  }
  return result;
}

}  // namespace stillmap
