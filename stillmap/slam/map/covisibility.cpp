// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/map/covisibility.hpp"

#include <algorithm>

namespace stillmap {

std::vector<CovisibleKeyframe> keyframes_seeing(const Map& map,
                                                std::span<const LandmarkId> landmarks) {
  if (map.keyframes().empty()) return {};
  std::vector<int> counts(map.keyframes().rbegin()->first.index() + 1, 0);
  for (const LandmarkId id : landmarks) {
    const Landmark* landmark = map.find(id);
    if (landmark == nullptr) continue;
    for (const Observation& observation : landmark->observations) {
      ++counts[observation.keyframe.index()];
    }
  }
  std::vector<CovisibleKeyframe> keyframes;
  for (std::uint32_t k = 0; k < counts.size(); ++k) {
    if (counts[k] > 0) keyframes.push_back({KeyframeId(k), counts[k]});
  }
  std::ranges::stable_sort(keyframes, std::ranges::greater{}, &CovisibleKeyframe::shared_landmarks);
  return keyframes;
}

std::vector<CovisibleKeyframe> covisible_keyframes(const Map& map, KeyframeId keyframe) {
  std::vector<CovisibleKeyframe> all = keyframes_seeing(map, map.keyframe(keyframe).landmarks);
  std::erase_if(all, [&](const CovisibleKeyframe& other) { return other.id == keyframe; });
  return all;
}

}  // namespace stillmap
