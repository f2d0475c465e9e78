// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"

namespace stillmap {

/// What a key frame brings to the verification of a loop.
struct LoopView {
  FeaturesPtr features;
  /// Per feature the point it sees, in the camera's frame, where one is known.
  std::vector<std::optional<Eigen::Vector3d>> p_camera;
  KeyframeId keyframe;  ///< invalid for a view that is of none
};

/// The points are those of the key frame's landmarks, else what the sensor's depth says.
[[nodiscard]] LoopView loop_view(const Keyframe& keyframe,
                                 const Map& map,
                                 const CameraModel& camera,
                                 const MeasurementModel& measure);

}  // namespace stillmap
