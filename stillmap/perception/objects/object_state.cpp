// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/object_state.hpp"

namespace stillmap {

std::string_view category_name(Category category) {
  switch (category) {
    case Category::kDynamic:
      return "dynamic";
    case Category::kPotentiallyDynamic:
      return "potentially dynamic";
    case Category::kStatic:
      break;
  }
  return "static";
}

std::string_view reason_name(StateReason reason) {
  switch (reason) {
    case StateReason::kBoxesApart:
      return "nobody near";
    case StateReason::kDepthsApart:
      return "apart in depth";
    case StateReason::kNotAsked:
      return "interaction not judged";
    case StateReason::kDynamicClass:
      return "dynamic class";
    case StateReason::kTouching:
      return "somebody at it";
    case StateReason::kDepthUnknown:
      return "somebody may be at it";
    case StateReason::kMoving:
      return "moving";
    case StateReason::kStaticClass:
      break;
  }
  return "static class";
}

std::string_view motion_name(MotionState state) {
  switch (state) {
    case MotionState::kStill:
      return "still";
    case MotionState::kMoving:
      return "moving";
    case MotionState::kMovedBySomeone:
      return "moved by someone";
    case MotionState::kUnknown:
      break;
  }
  return "unknown";
}

}  // namespace stillmap
