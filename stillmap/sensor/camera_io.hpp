// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// Reads a camera file; docs/cameras.md describes its keys. The files of other programs that
/// read_foreign_camera() knows are read, too. Throws Error with file and line for an unknown,
/// missing or repeated key, for a value that is no finite number, and for a camera that
/// check_camera() refuses.
[[nodiscard]] CameraModel read_camera_yaml(const std::filesystem::path& path);

/// The camera of that name: a built-in one, else a camera file. Throws Error as read_camera_yaml
/// does; for a name that is neither, as builtin_camera does, unless it has a '/' or ends as the
/// names of camera files do.
[[nodiscard]] CameraModel camera_by_name(const std::string& name_or_file);

/// The text of a camera file: read_camera_yaml reads back the same camera bit by bit.
[[nodiscard]] std::string format_camera_yaml(const CameraModel& camera);

/// The camera of a rendered sequence, from `truth/objects.json`. Throws Error as above.
[[nodiscard]] CameraModel read_truth_camera(const std::filesystem::path& objects_json);

/// Throws Error, starting with `place`, for a camera with invalid values: sides that are not 1 to
/// 8192 pixels, a number that is not finite, focal lengths or a depth factor that are not positive,
/// a readout not from 0 to 1 s, a fish-eye with coefficients that it does not have.
void check_camera(const CameraModel& camera, const std::string& place);

}  // namespace stillmap
