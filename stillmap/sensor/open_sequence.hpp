// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "stillmap/geometry/camera.hpp"
#include "stillmap/sensor/frame_stream.hpp"

namespace stillmap {

/// The frames of a recorded sequence: a folder of images in one of the layouts of docs/inputs.md,
/// which is recognised or called `format`. Without `camera`, the camera is that of the folder's
/// camera.yaml, else the layout's own, else the one that a word of the folder's name tells. Throws
/// Error, with file and line, for a folder that is not such a sequence or whose camera is not
/// known.
[[nodiscard]] std::unique_ptr<FrameStream> open_sequence(
    const std::filesystem::path& folder,
    const std::optional<CameraModel>& camera = std::nullopt,
    const std::string& format = {});

}  // namespace stillmap
