// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"

namespace stillmap {

/// The input of loop verification from one key frame.
struct LoopView {
  FeaturesPtr features;
  /// For each feature its point in camera coordinates, if known.
  std::vector<std::optional<Eigen::Vector3d>> p_camera;
  KeyframeId keyframe;  ///< invalid for a view of no key frame
};

/// Makes the view of a key frame. Points are those of its landmarks, else from the sensor's depth.
[[nodiscard]] LoopView loop_view(const Keyframe& keyframe,
                                 const Map& map,
                                 const CameraModel& camera,
                                 const MeasurementModel& measure);

}  // namespace stillmap
