// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/core/camera.hpp"
#include "stillmap/loop_closing/loop_config.hpp"
#include "stillmap/loop_closing/loop_detector.hpp"
#include "stillmap/map/map.hpp"
#include "stillmap/optim/measurement_model.hpp"

namespace stillmap {

/// Makes one place of the two ends of a loop: within a world the key frames are moved so that they
/// fit all loops (pose graph), else the later world moves into the earlier; then the landmarks of
/// both ends are merged.
///
/// False, with nothing done, where the other loops and the map contradict it. `loops` are those
/// closed before; this one joins them when it is closed. `map` is the whole map, with no window of
/// it being worked on.
[[nodiscard]] bool close_loop(Map& map,
                              std::vector<LoopEdge>& loops,
                              const FoundLoop& found,
                              const CameraModel& camera,
                              const MeasurementModel& measure,
                              const LoopConfig& config);

}  // namespace stillmap
