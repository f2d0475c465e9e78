// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/core/fields.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"

namespace stillmap {

struct LandmarkCreationConfig {
  double max_depth_m = 6.0;
  int min_landmarks = 100;
  int neighbors = 10;
  double min_parallax_deg = 1.0;
  int max_distance = 50;
  double max_line_px = 2.0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_depth_m",
          self.max_depth_m,
          FieldInfo{"a feature becomes a landmark from its depth alone up to here", "m", 0.1, 100});
    visit("min_landmarks",
          self.min_landmarks,
          FieldInfo{"nearest features that become landmarks at any depth", "", 0, 10000});
    visit("neighbors",
          self.neighbors,
          FieldInfo{"key frames that features without depth are triangulated with", "", 0, 100});
    visit("min_parallax_deg",
          self.min_parallax_deg,
          FieldInfo{"angle between the rays of a triangulated point", "deg", 0.01, 45});
    visit("max_distance",
          self.max_distance,
          FieldInfo{"differing bits of the 256 of two descriptors that are triangulated, at most",
                    "bits",
                    0,
                    256});
    visit("max_line_px",
          self.max_line_px,
          FieldInfo{"distance from the epipolar line of features that are triangulated, on the "
                    "finest level",
                    "px",
                    0.1,
                    50});
  }
};

/// Makes landmarks of the key frame's features that see none, from their depth.
void create_landmarks_from_depth(Map& map,
                                 KeyframeId keyframe,
                                 const CameraModel& camera,
                                 const MeasurementModel& measure,
                                 const LandmarkCreationConfig& config);

/// Makes landmarks of features that have no depth in at least one of two views: matches them along
/// epipolar lines between the key frame and its best covisible neighbours and triangulates.
/// Returns how many.
int triangulate_landmarks(Map& map,
                          KeyframeId keyframe,
                          const CameraModel& camera,
                          const MeasurementModel& measure,
                          const LandmarkCreationConfig& config);

}  // namespace stillmap
