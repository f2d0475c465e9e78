// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/sensor/frame_stream.hpp"

namespace stillmap {

/// The frames of a recorded sequence: a folder in the layout of the TUM RGB-D benchmark. Without
/// `camera`, the camera is found as by TumSequence::open(). Throws Error, with file and line, for a
/// folder that is not such a sequence or whose camera is not known.
[[nodiscard]] std::unique_ptr<FrameStream> open_sequence(
    const std::filesystem::path& folder, const std::optional<CameraModel>& camera = std::nullopt);

}  // namespace stillmap
