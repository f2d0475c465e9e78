// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "stillmap/system/dynamics_stage.hpp"
#include "stillmap/tracking/tracked_frame.hpp"

namespace stillmap {

struct StageTime {
  std::string_view stage;
  double ms = 0;
};

/// What the system tells of one frame.
struct FrameResult {
  TrackedFrame tracked;
  FrameDynamics dynamics;  ///< empty when nothing is done about what moves
  bool is_keyframe = false;
  double pose_ms = 0;  ///< of all that leads to its pose, preparation included
  /// In order; "mapping" includes waiting for it, "dynamics" and "features" their preparation.
  std::vector<StageTime> stages;
};

}  // namespace stillmap
