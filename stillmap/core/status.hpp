// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace stillmap {

/// The outcome of tracking for one frame.
enum class TrackingStatus : std::uint8_t {
  kInitialized,  ///< the first frame of a submap: its camera is the submap's origin
  kTracked,      ///< a pose was found from the frames before
  kRelocalized,  ///< a pose was found again after a loss
  kLost,         ///< no pose
};

/// The verdict on a feature. If several apply, it is the first of
/// kDynamic, kUnstableDepth, kMissingDepth, kStaticInBox, kStable.
enum class FeatureVerdict : std::uint8_t {
  kStable,         ///< none of the others
  kMissingDepth,   ///< a pixel around it has no depth
  kUnstableDepth,  ///< the depth around it varies too much
  kDynamic,        ///< in the box of a dynamic object and not a static match
  kStaticInBox,    ///< in the box of a dynamic object and a static match
  kDoubted,        ///< on a dynamic object: used where the others are too few
};

/// What the matches of a frame are judged by.
enum class MatchJudge : std::uint8_t {
  kNotAsked,     ///< there are none to be judged
  kNothing,      ///< the motion of the camera is not known
  kFundamental,  ///< a fundamental matrix from matches
  kRotation,     ///< the rotation of a camera that only rotates, and depth
  kPrediction,   ///< the predicted motion: the matches were too few, or contradict each other
};

/// The wall-clock time of one stage's work on a frame.
struct StageTime {
  std::string_view stage;  ///< refers to a literal
  double ms = 0;           ///< milliseconds
};

}  // namespace stillmap
