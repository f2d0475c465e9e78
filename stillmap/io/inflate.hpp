// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace stillmap {

/// The content of a whole zlib stream (RFC 1950 and 1951), if it has exactly `size` bytes and the
/// stream's checksum is right; nothing for any other or damaged stream. Never reads beyond the
/// stream. Allocates `size` bytes, but never more than a stream of that length can hold.
///
/// Uses libdeflate, which decompresses whole buffers in less than half of zlib's time. Most of the
/// time of reading a sequence is spent here.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> inflate_whole(std::string_view stream,
                                                                     std::size_t size);

}  // namespace stillmap
