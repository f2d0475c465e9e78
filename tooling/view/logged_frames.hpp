// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stillmap/core/trajectory.hpp"
#include "tooling/view/viewed_frame.hpp"

namespace stillmap {

/// What a run folder keeps of its frames.
struct LoggedRun {
  Trajectory trajectory = {};
  Trajectory keyframes = {};
  std::string objects_jsonl = {};          ///< empty: none
  std::string objects_name = {};           ///< of its file, for messages
  std::optional<CameraModel> camera = {};  ///< for the sizes of objects
};

/// The frames of a run folder, for the viewer: those of objects.jsonl, else those of the
/// trajectory. Throws Error, with name and line, where objects.jsonl is not what a run writes.
[[nodiscard]] std::vector<ViewedFrame> logged_frames(const LoggedRun& run);

}  // namespace stillmap
