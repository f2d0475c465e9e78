// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "stillmap/sensor/sequence_formats.hpp"

namespace stillmap {

/// The folders of a recording's colour and depth images.
struct ImageFolders {
  std::filesystem::path color;
  std::filesystem::path depth;
};

/// The subfolders color/ (or rgb/, image/, images/) and depth/, else the only ones with "color" or
/// "rgb" and with "depth" in their names; nothing where there are none or more.
[[nodiscard]] std::optional<ImageFolders> find_image_folders(const std::filesystem::path& folder);

/// Whether find_image_folders() finds some.
[[nodiscard]] bool is_image_folders(const std::filesystem::path& folder);

/// Reads images in two folders, paired by the numbers in their names (see pair_numbered()): what
/// Open3D's recorders, the Redwood data sets and many cameras' tools write. A JSON file with an
/// "intrinsic_matrix" beside the folders gives the camera; without "depth_scale" in it, depth is in
/// millimetres. True poses come from groundtruth.txt or a trajectory log (*.log). Throws Error as
/// pair_numbered() does, and for a broken JSON file.
[[nodiscard]] SequenceContent open_image_folders(const std::filesystem::path& folder,
                                                 const ReadingOptions& options);

}  // namespace stillmap
