// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "stillmap/core/error.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/sensor/frame_selection.hpp"
#include "stillmap/sensor/sequence.hpp"

namespace stillmap {

/// The camera that took a sequence, and how its depth unit is known.
struct SensorCamera {
  CameraModel camera;
  std::string depth_unit;  // what its images tell; empty where the unit was given
};

/// The error of depth images whose unit is not known.
class UnknownDepthUnit : public Error {
 public:
  using Error::Error;
};

/// The camera of a sequence with `depth_factor`, where that is given. If neither it nor the camera
/// says the unit of depth, the first images tell it. Throws UnknownDepthUnit where they do not.
[[nodiscard]] SensorCamera sensor_camera(const Sequence& sequence,
                                         const FrameSelection& selection,
                                         std::optional<double> depth_factor);

}  // namespace stillmap
