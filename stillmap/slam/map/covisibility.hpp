// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/slam/map/map.hpp"

namespace stillmap {

struct CovisibleKeyframe {
  KeyframeId id;
  int shared_landmarks = 0;
};

/// The other key frames that see landmarks of `keyframe`, most shared first, ties by id.
[[nodiscard]] std::vector<CovisibleKeyframe> covisible_keyframes(const Map& map,
                                                                 KeyframeId keyframe);

/// The same for a set of landmarks: the key frames that see most of them first.
[[nodiscard]] std::vector<CovisibleKeyframe> keyframes_seeing(
    const Map& map, std::span<const LandmarkId> landmarks);

}  // namespace stillmap
