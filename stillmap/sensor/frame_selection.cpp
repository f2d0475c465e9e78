// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/frame_selection.hpp"

#include <charconv>
#include <string_view>

#include "stillmap/core/error.hpp"

namespace stillmap {

FrameSelection parse_frames(const std::string& text) {
  const Error bad("{}: expected A:B with A < B, counted from 0, such as 0:100 or 50:", text);
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) throw bad;
  const auto number = [&](std::string_view digits) {
    std::size_t value = 0;
    const auto [last, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || last != digits.data() + digits.size()) throw bad;
    return value;
  };
  const std::string_view begin = std::string_view(text).substr(0, colon);
  const std::string_view end = std::string_view(text).substr(colon + 1);
  FrameSelection selection;
  if (!begin.empty()) selection.begin = number(begin);
  if (!end.empty()) selection.end = number(end);
  if (selection.end && *selection.end <= selection.begin) throw bad;
  return selection;
}

}  // namespace stillmap
