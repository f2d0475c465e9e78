// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "stillmap/sensor/sequence_formats.hpp"

namespace stillmap {

/// The files of a folder whose names end with `ending` (empty: of any image), in no order.
[[nodiscard]] std::vector<std::filesystem::path> files_ending(const std::filesystem::path& folder,
                                                              std::string_view ending);

/// Pairs images by the last numbers in their names. These are frame numbers, of which equal ones
/// belong together, or stamps, if their steps or sizes say so; then the nearest belong together, as
/// in pair_by_stamp(). The texts of the stamps give seconds. Camera and ground truth are not set.
/// Throws Error, naming the folder, for no images, a name without a number, a number that occurs
/// twice, and where no two images belong together.
[[nodiscard]] SequenceContent pair_numbered(const std::vector<std::filesystem::path>& color,
                                            const std::vector<std::filesystem::path>& depth,
                                            const std::filesystem::path& folder,
                                            const ReadingOptions& options);

}  // namespace stillmap
