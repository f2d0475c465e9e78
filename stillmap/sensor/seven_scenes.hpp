// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "stillmap/sensor/sequence_formats.hpp"

namespace stillmap {

/// Whether a folder holds images such as frame-000000.color.png.
[[nodiscard]] bool is_seven_scenes(const std::filesystem::path& folder);

/// Reads a sequence of the 7-Scenes data set (Shotton et al. 2013): frame-N.color.png,
/// frame-N.depth.png in millimetres, frame-N.pose.txt. The camera is the one that the data set
/// names, a Kinect with focal length 585 and its principal point in the middle. Throws Error as
/// pair_numbered() does.
[[nodiscard]] SequenceContent open_seven_scenes(const std::filesystem::path& folder,
                                                const ReadingOptions& options);

}  // namespace stillmap
