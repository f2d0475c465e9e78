// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/mapping/culling.hpp"

#include "stillmap/slam/map/covisibility.hpp"

namespace stillmap {
namespace {

// The number of other key frames that observe the landmark on the same or a finer level.
int fine_observers(const Map& map, const Landmark& landmark, KeyframeId keyframe, int level) {
  int count = 0;
  for (const Observation& observation : landmark.observations) {
    if (observation.keyframe == keyframe) continue;
    const Features& features = *map.keyframe(observation.keyframe).features;
    if (features.level[observation.feature] <= level + 1) ++count;
  }
  return count;
}

bool is_redundant(const Map& map,
                  const Keyframe& keyframe,
                  const MeasurementModel& measure,
                  const CullingConfig& config) {
  int seen = 0, redundant = 0;
  for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i) {
    const Landmark* landmark = map.find(keyframe.landmarks[i]);
    if (landmark == nullptr || !measure.has_depth(*keyframe.features, i)) continue;
    ++seen;
    const int observers = fine_observers(map, *landmark, keyframe.id, keyframe.features->level[i]);
    if (observers >= config.redundant_observers) ++redundant;
  }
  return redundant > config.redundant_ratio * seen;
}

}  // namespace

int cull_young_landmarks(Map& map, KeyframeId newest, const CullingConfig& config) {
  int removed = 0;
  for (const LandmarkId id : map.landmark_ids()) {
    const Landmark& landmark = map.landmark(id);
    const auto age = static_cast<int>(newest.value - landmark.created_by.value);
    if (age > config.probation_keyframes) continue;
    const bool rarely_found =
        landmark.times_found < config.min_found_ratio * landmark.times_expected;
    const bool rarely_seen =
        age >= 2 && std::ssize(landmark.observations) < config.min_observations;
    if (!rarely_found && !rarely_seen) continue;
    map.remove_landmark(id);
    ++removed;
  }
  return removed;
}

int cull_redundant_keyframes(Map& map,
                             std::span<const KeyframeId> candidates,
                             KeyframeId newest,
                             const MeasurementModel& measure,
                             const CullingConfig& config) {
  int removed = 0;
  for (const KeyframeId id : candidates) {
    if (id == newest || map.keyframe(id).is_origin) continue;
    if (!is_redundant(map, map.keyframe(id), measure, config)) continue;
    const std::vector<CovisibleKeyframe> neighbors = covisible_keyframes(map, id);
    if (neighbors.empty()) continue;
    map.remove_keyframe(id, neighbors.front().id);
    ++removed;
  }
  return removed;
}

}  // namespace stillmap
