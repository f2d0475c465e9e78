// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/mapping/map_adjustment.hpp"

#include <set>

#include "stillmap/slam/mapping/map_problem.hpp"

namespace stillmap {

void adjust_map(Map& map,
                std::span<const KeyframeId> free_keyframes,
                const CameraModel& camera,
                const MeasurementModel& measure,
                const BundleConfig& config) {
  const std::set<KeyframeId> free(free_keyframes.begin(), free_keyframes.end());
  const MapProblem indexed = make_problem(map, free, camera, measure);
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
