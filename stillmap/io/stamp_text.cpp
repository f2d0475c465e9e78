// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/stamp_text.hpp"

#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/core.h>

namespace stillmap {

std::optional<Stamp> parse_stamp(std::string_view text) {
  if (text.size() > kMaxStampLength) return std::nullopt;
  Stamp stamp;
  const char* const end = text.data() + text.size();
  const auto [parsed, status] = std::from_chars(text.data(), end, stamp.seconds);
  if (status != std::errc() || parsed != end || !std::isfinite(stamp.seconds)) return std::nullopt;
  stamp.text = text;
  return stamp;
}

std::string stamp_text(const Stamp& stamp) {
  if (!stamp.text.empty()) return stamp.text;
  const std::string text = fmt::format("{:.6f}", stamp.seconds);
  return text.size() <= kMaxStampLength ? text : fmt::format("{}", stamp.seconds);
}

}  // namespace stillmap
