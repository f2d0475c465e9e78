// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/loop/loop_config.hpp"
#include "stillmap/slam/loop/loop_detector.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"

namespace stillmap {

/// Closes a loop. Within a submap the key frames are moved to fit all loops (pose graph); between
/// submaps the later one moves into the earlier. Then the landmarks of both ends are merged.
///
/// Does nothing and returns false if the other loops and the map contradict the loop. `loops` are
/// the loops closed before; a closed loop is appended. `map` is the whole map; no window of it may
/// be in work.
[[nodiscard]] bool close_loop(Map& map,
                              std::vector<LoopEdge>& loops,
                              const LoopMatch& found,
                              const CameraModel& camera,
                              const MeasurementModel& measure,
                              const LoopConfig& config);

}  // namespace stillmap
