// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace stillmap {

/// The text of a file in UTF-8: without a byte order mark, and converted where the mark says
/// UTF-16, as Windows writes. Throws Error as read_file() does, and for UTF-16 of an odd number of
/// bytes or with half a surrogate pair.
[[nodiscard]] std::string read_text(const std::filesystem::path& path, std::size_t max_bytes);

}  // namespace stillmap
