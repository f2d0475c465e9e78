// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace stillmap {

/// What the matches of a frame are judged by.
enum class MatchJudge : std::uint8_t {
  kNotAsked,     ///< there are none to be judged
  kNothing,      ///< the motion of the camera is not known
  kFundamental,  ///< a fundamental matrix from matches
  kRotation,     ///< the rotation of a camera that only rotates, and depth
  kPrediction,   ///< the predicted motion: the matches were too few, or contradict each other
};

/// Its name in reports.
[[nodiscard]] std::string_view match_judge_name(MatchJudge judge);

}  // namespace stillmap
