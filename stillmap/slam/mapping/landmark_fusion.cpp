// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/mapping/landmark_fusion.hpp"

#include <algorithm>

#include "stillmap/slam/features/matcher.hpp"
#include "stillmap/slam/map/landmark_projection.hpp"
#include "stillmap/slam/optim/reprojection.hpp"

namespace stillmap {
namespace {

bool seen_by(const Landmark& landmark, KeyframeId keyframe) {
  return std::ranges::binary_search(landmark.observations, keyframe, {}, &Observation::keyframe);
}

}  // namespace

int fuse_landmarks(Map& map,
                   KeyframeId keyframe,
                   std::span<const LandmarkId> landmarks,
                   const CameraModel& camera,
                   const MeasurementModel& measure,
                   const LandmarkFusionConfig& config) {
  const Eigen::Isometry3d T_camera_world = map.keyframe(keyframe).T_world_camera.inverse();
  const FeaturesPtr features = map.keyframe(keyframe).features;
  std::vector<LandmarkId> projected;
  std::vector<Projection> projections;
  for (const LandmarkId id : landmarks) {
    const Landmark* landmark = map.find(id);
    if (landmark == nullptr || seen_by(*landmark, keyframe)) continue;
    const std::optional<Projection> projection = project_landmark(
        camera, measure.level_scales(), T_camera_world, *landmark, config.radius_px);
    if (!projection) continue;
    projected.push_back(id);
    projections.push_back(*projection);
  }
  int found = 0;
  for (const FeatureMatch& match :
       match_projections(projections, *features, {}, {.max_distance = config.max_distance})) {
    const LandmarkId id = projected[match.query];
    const Landmark* landmark = map.find(id);  // an earlier merge may have taken it
    if (landmark == nullptr || seen_by(*landmark, keyframe)) continue;
    const Eigen::Vector3d p_camera = T_camera_world * landmark->p_world;
    if (!agrees_with(camera, measure(*features, match.feature), p_camera)) continue;
    const LandmarkId present = map.keyframe(keyframe).landmarks[match.feature];
    if (!present.valid()) {
      map.add_observation(id, {keyframe, match.feature});
    } else if (const Landmark* other = map.find(present)) {
      const bool keep_other = other->observations.size() >= landmark->observations.size();
      map.merge_landmarks(keep_other ? id : present, keep_other ? present : id);
    } else {
      continue;  // it belongs to a landmark outside the window
    }
    ++found;
  }
  return found;
}

}  // namespace stillmap
