// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "stillmap/sensor/sequence_formats.hpp"

namespace stillmap {

/// Whether a folder has one of the lists of the TUM RGB-D benchmark.
[[nodiscard]] bool is_tum_lists(const std::filesystem::path& folder);

/// The list of pairs in a folder (associations.txt, association.txt, associate.txt or
/// associated.txt); empty where there is none.
[[nodiscard]] std::filesystem::path pairs_file(const std::filesystem::path& folder);

/// Reads the layout of the TUM RGB-D benchmark. Pairs come from associations.txt where there is
/// one, else from the stamps in rgb.txt and depth.txt: less than 0.02 s apart, the closest first,
/// each image once. Throws Error, with file and line, for a missing or empty list, stamps that
/// decrease, a file outside the folder, or no pair at all.
[[nodiscard]] SequenceContent open_tum_lists(const std::filesystem::path& folder,
                                             const ReadingOptions& options);

}  // namespace stillmap
