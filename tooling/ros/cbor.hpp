// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace stillmap {

/// What a message may hold at most, in CBOR and in JSON: values in each other, and values in all.
/// Images are one value each.
inline constexpr int kMaxValueDepth = 16;
inline constexpr std::size_t kMaxValues = 100'000;

/// Reads one item of CBOR (RFC 8949) that is all of `bytes`. A byte string keeps the tag before it
/// as its subtype; other tags mean nothing here. The memory taken is in proportion to the bytes.
/// (nlohmann::json::from_cbor copies byte by byte and follows any number of tags by recursion.)
/// Throws DamagedImage, beginning with `place`, for anything else, for keys that are no text, for
/// items of unknown length, and beyond the limits above.
[[nodiscard]] nlohmann::json read_cbor(std::string_view bytes, const std::string& place);

}  // namespace stillmap
