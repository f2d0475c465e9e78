// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "stillmap/slam/map/keyframe.hpp"
#include "stillmap/slam/map/landmark.hpp"
#include "stillmap/slam/map/map_update.hpp"

namespace stillmap {

/// The parts of a map as lists, for saving. They do not have the history of merged landmarks, nor
/// changes that were not taken.
struct MapParts {
  std::vector<float> level_scales;
  std::vector<Keyframe> keyframes;                               ///< by id
  std::vector<Landmark> landmarks;                               ///< by id
  std::vector<std::pair<KeyframeId, Anchor>> dropped_keyframes;  ///< by id
  KeyframeId next_keyframe{0};
  LandmarkId next_landmark{0};
};

/// The upper bound of ids of key frames, landmarks and submaps.
inline constexpr std::uint32_t kMaxId = std::uint32_t{1} << 31U;
/// The greatest number of features of a key frame; the place index can count no more.
inline constexpr std::size_t kMaxFeatures = 65535;
/// The greatest coordinate. Beyond it squares and sums lose their precision.
inline constexpr double kMaxCoordinate_m = 1e9;

/// Whether a pose is a rotation, to 1e-6, and a position within kMaxCoordinate_m. False for NaN.
[[nodiscard]] bool is_rigid(const Eigen::Isometry3d& T);

/// Whether the time is finite and the text, if any, one short word.
[[nodiscard]] bool is_stamp(const Stamp& stamp);

/// Throws Error, in one line that begins with `place`, for parts that form no map: ids out of order
/// or of missing items, invalid poses, arrays of different length, a submap without its one origin,
/// anchors that lead to no key frame, impossible numbers. Ignores the key frames' lists of
/// landmarks; see linked().
void check_parts(const MapParts& parts, const std::string& place);

/// The parts with the key frames' lists of landmarks rebuilt from the observations. Throws Error
/// when a feature observes two landmarks. The parts must have passed check_parts().
[[nodiscard]] MapParts linked(MapParts parts, const std::string& place);

}  // namespace stillmap
