// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "stillmap/sensor/sequence_formats.hpp"

namespace stillmap {

/// Whether a folder has color/, depth/ and pose/.
[[nodiscard]] bool is_scannet(const std::filesystem::path& folder);

/// Reads what ScanNet's SensReader exports: color/N.jpg, depth/N.png in millimetres, pose/N.txt,
/// and intrinsic_depth.txt, intrinsic_color.txt in intrinsic/ or in the folder itself. The camera
/// is that of the depth images, because both cameras have one centre; colour of another size is
/// resampled to it. Throws Error as pair_numbered() does, and for missing or broken intrinsics.
[[nodiscard]] SequenceContent open_scannet(const std::filesystem::path& folder,
                                           const ReadingOptions& options);

}  // namespace stillmap
