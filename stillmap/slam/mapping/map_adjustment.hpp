// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/optim/bundle_adjuster.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"

namespace stillmap {

/// Bundle adjustment of a map. Moves the poses of `free_keyframes` and every landmark that one of
/// them observes; all other key frames, and origins, are held. Removes the observations that end
/// outside the 95 % bound.
void adjust_map(Map& map,
                std::span<const KeyframeId> free_keyframes,
                const CameraModel& camera,
                const MeasurementModel& measure,
                const BundleConfig& config);

}  // namespace stillmap
