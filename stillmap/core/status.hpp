// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace stillmap {

enum class TrackingStatus : std::uint8_t {
  kInitialized,  ///< the first frame of a submap: its camera is the submap's origin
  kTracked,
  kRelocalized,  ///< found again after having been lost
  kLost,         ///< no pose; the frame is marked, nothing is invented
};

/// The verdict on a feature off the masks. Where several hold, the first of kDynamic,
/// kUnstableDepth, kMissingDepth, kStaticInBox, kStable is given.
enum class FeatureVerdict : std::uint8_t {
  kStable,
  kMissingDepth,   ///< a pixel around it has no depth
  kUnstableDepth,  ///< depth changes suddenly around it
  kDynamic,        ///< in the box of a dynamic object, and not seen to stand still
  kStaticInBox,    ///< in such a box, and seen to stand still
};

/// Wall-clock time of one stage's work on a frame.
struct StageTime {
  std::string_view stage;  ///< refers to a literal
  double ms = 0;
};

}  // namespace stillmap
