// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "stillmap/geometry/camera.hpp"
#include "tooling/ros/ros_message.hpp"

namespace stillmap {

/// The camera of a CameraInfo: K with its distortion, that of every lens that camera files may
/// have; of rectified images, which have none, P. Depth is in millimetres, as ROS has it. Throws
/// Error, beginning with `place`, for another distortion and a camera that is not calibrated.
[[nodiscard]] CameraModel camera_of_info(const RosCameraInfo& info,
                                         bool rectified,
                                         const std::string& place);

/// Whether the depth camera's info has the focal length and centre of the colour camera, within 2
/// px, as it has when depth is registered to colour.
[[nodiscard]] bool looks_registered(const RosCameraInfo& depth, const CameraModel& color);

}  // namespace stillmap
