// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"

namespace stillmap {

/// Finds landmarks again in a key frame that should see them: `landmarks` are projected into it and
/// matched. Where the matched feature sees no landmark it gets an observation of this one; where it
/// sees another, the two are merged into the one with more observations. Returns how many were
/// found.
int fuse_landmarks(Map& map,
                   KeyframeId keyframe,
                   std::span<const LandmarkId> landmarks,
                   const CameraModel& camera,
                   const MeasurementModel& measure,
                   double radius_px);

}  // namespace stillmap
