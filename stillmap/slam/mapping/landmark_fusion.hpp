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
    visit(
        "fusion_radius_px",
        self.radius_px,
        FieldInfo{"search radius for a landmark in another key frame, at the finest pyramid level",
                  "px",
                  0.5,
                  50});
    visit("fusion_max_distance",
          self.max_distance,
          FieldInfo{"greatest Hamming distance of the descriptors of a landmark and a feature that "
                    "are fused",
                    "bits",
                    0,
                    256});
  }
};

/// Searches landmarks in a key frame in which they should be visible: `landmarks` are projected
/// into it and matched. A matched feature without a landmark becomes an observation of the
/// landmark; if the feature observes another, the two are merged into the one with more
/// observations. Returns the number of matches.
int fuse_landmarks(Map& map,
                   KeyframeId keyframe,
                   std::span<const LandmarkId> landmarks,
                   const CameraModel& camera,
                   const MeasurementModel& measure,
                   const LandmarkFusionConfig& config);

}  // namespace stillmap
