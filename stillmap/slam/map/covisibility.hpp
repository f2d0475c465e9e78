// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/slam/map/map.hpp"

namespace stillmap {

struct CovisibleKeyframe {
  KeyframeId id;
  int shared_landmarks = 0;
};

/// The other key frames that observe landmarks of `keyframe`, those with most common landmarks
/// first, ties by id.
[[nodiscard]] std::vector<CovisibleKeyframe> covisible_keyframes(const Map& map,
                                                                 KeyframeId keyframe);

/// The key frames that observe some of the landmarks, those with most of them first, ties by id.
[[nodiscard]] std::vector<CovisibleKeyframe> keyframes_seeing(
    const Map& map, std::span<const LandmarkId> landmarks);

}  // namespace stillmap
