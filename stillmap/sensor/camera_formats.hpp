// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/sensor/camera_values.hpp"

namespace stillmap {

/// The camera of a file of another program, recognised by its keys: ORB-SLAM2 and 3, stella_vslam,
/// a calibration or CameraInfo of ROS or OpenCV, Open3D's and RealSense's JSON. Keys that describe
/// no camera are passed over. Nothing for any other file, stillmap's own included. Throws Error for
/// values that are missing or make no camera that stillmap has.
[[nodiscard]] std::optional<CameraModel> read_foreign_camera(const CameraValues& values);

}  // namespace stillmap
