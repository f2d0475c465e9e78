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

/// All that a map consists of, in lists: what is saved of it. Which landmarks were merged is no
/// part of it, nor are changes that nobody has taken.
struct MapParts {
  std::vector<float> level_scales;
  std::vector<Keyframe> keyframes;                               ///< by id
  std::vector<Landmark> landmarks;                               ///< by id
  std::vector<std::pair<KeyframeId, Anchor>> dropped_keyframes;  ///< by id
  KeyframeId next_keyframe{0};
  LandmarkId next_landmark{0};
};

/// Ids of key frames, landmarks and submaps are less.
inline constexpr std::uint32_t kMaxId = std::uint32_t{1} << 31U;
/// Features of a key frame; the place index can name no more.
inline constexpr std::size_t kMaxFeatures = 65535;
/// Beyond, squares and sums would lose all meaning.
inline constexpr double kMaxCoordinate_m = 1e9;

/// Whether it is a rotation, to 1e-6, and a place within kMaxCoordinate_m; false for what is no
/// number.
[[nodiscard]] bool is_rigid(const Eigen::Isometry3d& T);

/// Whether the time is a number and the text, if any, one short word.
[[nodiscard]] bool is_stamp(const Stamp& stamp);

/// Throws Error, in one line that starts with `place`, for parts that are of no map: ids that are
/// not in order or refer to nothing, poses that are none, arrays of different length, a submap
/// without its one origin, anchors that lead to no key frame, numbers that mean nothing. The key
/// frames' lists of landmarks are not looked at: see linked().
void check_parts(const MapParts& parts, const std::string& place);

/// The parts with the key frames' lists of landmarks made from the landmarks' observations. Throws
/// Error when a feature sees two. The parts are checked.
[[nodiscard]] MapParts linked(MapParts parts, const std::string& place);

}  // namespace stillmap
