// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// Reads a camera file: a YAML map with `width height fx fy cx cy`, and optionally `name k1 k2 p1
/// p2 k3 depth_factor readout_s` (defaults: no distortion, TUM's depth factor). Throws Error with
/// file and line for an unknown, missing or repeated key, for a value that is no finite number, and
/// for sizes, focal lengths or a depth factor that are not positive (sizes: at most 8192).
[[nodiscard]] CameraModel read_camera_yaml(const std::filesystem::path& path);

/// The camera of that name: a camera file where the text has a '/' or ends in ".yaml", else a
/// built-in camera. Throws Error as read_camera_yaml and builtin_camera do.
[[nodiscard]] CameraModel camera_by_name(const std::string& name_or_file);

/// The text of a camera file: read_camera_yaml reads back the same numbers bit by bit.
[[nodiscard]] std::string format_camera_yaml(const CameraModel& camera);

/// The camera of a rendered sequence, from `truth/objects.json`. Throws Error as above.
[[nodiscard]] CameraModel read_truth_camera(const std::filesystem::path& objects_json);

/// Throws Error, starting with `place`, for a camera with invalid values: see read_camera_yaml.
void check_camera(const CameraModel& camera, const std::string& place);

}  // namespace stillmap
