// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// A sequence that needs no renderer: a camera slides along a textured wall at 1.5 m, so that each
/// image is the same picture, shifted by a known number of pixels. 320x240, 30 Hz, with ground
/// truth. The camera moves 2 mm right and 1 mm down a frame.
void write_plane_sequence(const std::filesystem::path& folder, int frames);

/// The same wall and board through another camera, whose depth camera, if it has one, is moved, but
/// not turned, in their plane.
void write_plane_sequence(const std::filesystem::path& folder,
                          int frames,
                          const CameraModel& camera);

}  // namespace stillmap
