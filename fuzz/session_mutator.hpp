// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <random>
#include <string>
#include <string_view>

namespace stillmap {

/// Changes bytes in some way; the result has at most `max_size`.
using ByteMutator = std::function<std::string(std::string bytes, std::size_t max_size)>;

/// Changes the content of a section of a session file, or which sections there are, and puts the
/// checksums right: a checksum that is wrong leads nowhere.
[[nodiscard]] std::string mutate_session(std::string_view bytes,
                                         std::size_t max_size,
                                         std::mt19937& rng,
                                         const ByteMutator& mutate_bytes);

}  // namespace stillmap
