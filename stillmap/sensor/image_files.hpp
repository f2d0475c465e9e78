// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "stillmap/sensor/sequence_content.hpp"

namespace stillmap {

/// Reads the images of entries that name a file for each.
[[nodiscard]] std::shared_ptr<const ImageReader> read_image_files(
    std::vector<SequenceEntry> entries);

/// Whether a file is a PNG of 16-bit gray, as depth images are. False also where it cannot be read.
[[nodiscard]] bool is_depth_file(const std::filesystem::path& path);

}  // namespace stillmap
