// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "stillmap/core/fields.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"

namespace stillmap {

struct LandmarkFusionConfig {
  double radius_px = 6;
  int max_distance = 50;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("fusion_radius_px",
          self.radius_px,
          FieldInfo{"search for a landmark in another key frame that should see it, on the finest "
                    "level",
                    "px",
                    0.5,
                    50});
    visit("fusion_max_distance",
          self.max_distance,
          FieldInfo{"differing bits of the 256 of the descriptors of a landmark and a feature that "
                    "are fused, at most",
                    "bits",
                    0,
                    256});
  }
};

/// Finds landmarks again in a key frame that should see them: `landmarks` are projected into it and
/// matched. Where the matched feature sees no landmark it gets an observation of this one; where it
/// sees another, the two are merged into the one with more observations. Returns how many were
/// found.
int fuse_landmarks(Map& map,
                   KeyframeId keyframe,
                   std::span<const LandmarkId> landmarks,
                   const CameraModel& camera,
                   const MeasurementModel& measure,
                   const LandmarkFusionConfig& config);

}  // namespace stillmap
