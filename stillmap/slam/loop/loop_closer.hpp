// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/loop/loop_config.hpp"
#include "stillmap/slam/loop/loop_detector.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"

namespace stillmap {

/// Makes one place of the two ends of a loop: within a submap the key frames are moved so that they
/// fit all loops (pose graph), else the later submap moves into the earlier; then the landmarks of
/// both ends are merged.
///
/// False, with nothing done, where the other loops and the map contradict it. `loops` are those
/// closed before; this one joins them when it is closed. `map` is the whole map, with no window of
/// it being worked on.
[[nodiscard]] bool close_loop(Map& map,
                              std::vector<LoopEdge>& loops,
                              const LoopMatch& found,
                              const CameraModel& camera,
                              const MeasurementModel& measure,
                              const LoopConfig& config);

}  // namespace stillmap
