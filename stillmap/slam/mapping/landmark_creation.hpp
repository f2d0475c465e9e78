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
    visit(
        "max_depth_m",
        self.max_depth_m,
        FieldInfo{"greatest depth from which a single feature becomes a landmark", "m", 0.1, 100});
    visit("min_landmarks",
          self.min_landmarks,
          FieldInfo{"number of nearest features that become landmarks at any depth", "", 0, 10000});
    visit("neighbors",
          self.neighbors,
          FieldInfo{
              "number of key frames for the triangulation of features without depth", "", 0, 100});
    visit("min_parallax_deg",
          self.min_parallax_deg,
          FieldInfo{"least angle between the rays of a triangulated landmark", "deg", 0.01, 45});
    visit("max_distance",
          self.max_distance,
          FieldInfo{
              "greatest Hamming distance of the descriptors of two features that are triangulated",
              "bits",
              0,
              256});
    visit("max_line_px",
          self.max_line_px,
          FieldInfo{"greatest distance from the epipolar line of a triangulated feature, at the "
                    "finest pyramid level",
                    "px",
                    0.1,
                    50});
  }
};

/// Creates landmarks from the depth of the key frame's features that observe none.
void create_landmarks_from_depth(Map& map,
                                 KeyframeId keyframe,
                                 const CameraModel& camera,
                                 const MeasurementModel& measure,
                                 const LandmarkCreationConfig& config);

/// Creates landmarks from features without depth in at least one of two views: matches them along
/// epipolar lines between the key frame and its most covisible neighbours, and triangulates.
/// Returns the number created.
int triangulate_landmarks(Map& map,
                          KeyframeId keyframe,
                          const CameraModel& camera,
                          const MeasurementModel& measure,
                          const LandmarkCreationConfig& config);

}  // namespace stillmap
