// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// An image as a list names it.
struct ListedImage {
  std::optional<Stamp> stamp;  ///< the number in front of the name, as written
  std::string name;
  std::string place;  ///< "file:line", for messages
};

/// Whether a name ends as those of images do (.png, .jpg, .jpeg, in any case).
[[nodiscard]] bool has_image_suffix(std::string_view name);

/// The rows of a list with a stamp and a name each, such as rgb.txt. The name is the rest of the
/// row up to an image's suffix, so that it may hold blanks; it may stand in quotation marks. `#`
/// begins a comment line. Throws Error, with file and line, for a row without a stamp or a name, a
/// stamp that is no finite number, and an empty list.
[[nodiscard]] std::vector<ListedImage> read_image_list(const std::filesystem::path& path);

/// The rows of a list that pairs images, such as associations.txt: two names in each, in front of
/// each its stamp or none; what follows the second name is not read. Throws Error as
/// read_image_list() does.
[[nodiscard]] std::vector<std::pair<ListedImage, ListedImage>> read_image_pairs(
    const std::filesystem::path& path);

/// The file that a list below `folder` names. A backslash is taken for a slash. An absolute name
/// that was written on another machine is found by its last parts below the folder. Throws Error
/// for a name that leads out of the folder, unless it is an absolute one of an image.
[[nodiscard]] std::filesystem::path listed_file(const std::filesystem::path& folder,
                                                const ListedImage& image);

}  // namespace stillmap
