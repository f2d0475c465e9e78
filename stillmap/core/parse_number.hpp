// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace stillmap {

/// The number that the whole text is, in every locale; nothing for any other text, and for a number
/// that does not fit. Infinity and nan are numbers.
template <class Number>
[[nodiscard]] std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [parsed, status] = std::from_chars(text.data(), end, value);
  if (status != std::errc() || parsed != end) return std::nullopt;
  return value;
}

}  // namespace stillmap
