// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stillmap/core/trajectory.hpp"
#include "tooling/browser/viewed_frame.hpp"

namespace stillmap {

/// What a run folder keeps of its frames.
struct LoggedRun {
  Trajectory trajectory = {};
  Trajectory keyframes = {};
  std::string_view objects_jsonl = {};     ///< empty: none
  std::string objects_name = {};           ///< of its file, for messages
  std::optional<CameraModel> camera = {};  ///< for the sizes of objects
  std::vector<Stamp> lost = {};            ///< frames without a pose, where objects_jsonl is empty
};

/// The frames of a run folder, for pages: those of objects.jsonl, else those of the trajectory and
/// the lost ones; of more than `most` so many, evenly spread. Throws Error, with name and line,
/// where objects.jsonl is not what a run writes.
[[nodiscard]] std::vector<ViewedFrame> logged_frames(
    const LoggedRun& run, std::size_t most = std::numeric_limits<std::size_t>::max());

/// How many frames a run dropped, by the text of its report.json; 0 where that does not say it.
[[nodiscard]] std::size_t logged_drops(std::string_view report_json);

}  // namespace stillmap
