// SPDX-License-Identifier: Apache-2.0
#include "apps/picture_size.hpp"

#include <charconv>
#include <string_view>
#include <system_error>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

int parse_side(std::string_view text, const std::string& size) {
  constexpr int kSmallest = 32, kLargest = 4096;
  int side = 0;
  const char* end = text.data() + text.size();
  const std::from_chars_result parsed = std::from_chars(text.data(), end, side);
  if (parsed.ec != std::errc() || parsed.ptr != end || side < kSmallest || side > kLargest) {
    throw Error("--size {}: expected WIDTHxHEIGHT such as 640x480, each from {} to {}",
                size,
                kSmallest,
                kLargest);
  }
  return side;
}

}  // namespace

PictureSize parse_picture_size(const std::string& size) {
  const std::string_view text = size;
  const std::size_t cross = text.find('x');
  const std::string_view height =
      cross == std::string_view::npos ? std::string_view() : text.substr(cross + 1);
  return {parse_side(text.substr(0, cross), size), parse_side(height, size)};
}

}  // namespace stillmap
