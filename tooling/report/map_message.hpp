// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "tooling/report/run_report.hpp"
#include "tooling/report/scene_frame.hpp"

namespace stillmap {

inline constexpr std::size_t kMapMessagePoints = 150'000;

/// What the report's scripts draw: one message (docs/view.md) in base64, of a report with a map.
/// Evenly spread: at most `most_points` of the map, without strays, 1200 frames, the objects of 400
/// of these, with what moves in them where the report has it, and 300 key frames.
[[nodiscard]] std::string map_message(const RunReport& report,
                                      const SceneFrame& scene,
                                      std::size_t most_points = kMapMessagePoints);

}  // namespace stillmap
