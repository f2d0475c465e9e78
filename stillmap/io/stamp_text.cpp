// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/stamp_text.hpp"

#include <cmath>

#include <fmt/core.h>

#include "stillmap/core/parse_number.hpp"

namespace stillmap {

std::optional<Stamp> parse_stamp(std::string_view text) {
  if (text.size() > kMaxStampLength) return std::nullopt;
  const std::optional<double> seconds = parse_number<double>(text);
  if (!seconds || !std::isfinite(*seconds)) return std::nullopt;
  return Stamp{*seconds, std::string(text)};
}

std::string stamp_text(const Stamp& stamp) {
  if (!stamp.text.empty()) return stamp.text;
  const std::string text = fmt::format("{:.6f}", stamp.seconds);
  return text.size() <= kMaxStampLength ? text : fmt::format("{}", stamp.seconds);
}

}  // namespace stillmap
