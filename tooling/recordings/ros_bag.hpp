// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "stillmap/sensor/sequence_formats.hpp"

namespace stillmap {

/// Whether a file begins as bags of ROS 1 do.
[[nodiscard]] bool is_ros_bag(const std::filesystem::path& path);

/// Reads a bag of ROS 1: the images of the topics that ReadingOptions names, or of the only ones,
/// paired by the stamps in their headers as in pair_by_stamp(), and the camera of the colour
/// images. The whole bag is read once for the stamps. Throws Error for a file that is no readable
/// bag, topics that are missing or not clear, and depth of another size than colour; also in a
/// build without the library of bags.
[[nodiscard]] SequenceContent open_ros_bag(const std::filesystem::path& path,
                                           const ReadingOptions& options);

}  // namespace stillmap
