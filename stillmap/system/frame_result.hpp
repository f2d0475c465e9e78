// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "stillmap/perception/motion/dynamics_stage.hpp"
#include "stillmap/slam/tracking/tracked_frame.hpp"

namespace stillmap {

/// Whose objects a frame comes with.
enum class MaskOrigin : std::uint8_t {
  kOwn,      ///< those found in it; also where nothing looks for objects
  kAwaited,  ///< carried forward from earlier frames; its own are being looked for
  kCarried,  ///< carried forward; nobody looks for its own
};

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
