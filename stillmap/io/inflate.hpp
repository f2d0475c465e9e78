// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace stillmap {

/// What a whole zlib stream (RFC 1950 and 1951) decompresses to, if that is just `size` bytes and
/// the stream's checksum is right; nothing for any other or broken stream, of which no more is read
/// than there is. Allocates `size` bytes, but never more than a stream so long can hold.
///
/// By libdeflate, which with all of the stream and of the target at hand takes less than half of
/// zlib's time, where most of reading a sequence goes.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> inflate_whole(std::string_view stream,
                                                                     std::size_t size);

}  // namespace stillmap
