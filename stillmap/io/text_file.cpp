// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/text_file.hpp"

#include <cstdint>
#include <string_view>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"

namespace stillmap {
namespace {

void append_utf8(std::string& text, std::uint32_t code) {
  const auto add = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
  const auto rest = [&](std::uint32_t shift) { add(0x80U | ((code >> shift) & 0x3FU)); };
  if (code < 0x80U) return add(code);
  if (code < 0x800U) {
    add(0xC0U | (code >> 6U));
  } else if (code < 0x10000U) {
    add(0xE0U | (code >> 12U));
    rest(6);
  } else {
    add(0xF0U | (code >> 18U));
    rest(12);
    rest(6);
  }
  rest(0);
}

// `bytes` comes after the byte order mark.
std::string from_utf16(std::string_view bytes, bool little_endian, const std::string& name) {
  const Error broken("{}: broken UTF-16, expected UTF-8 or whole UTF-16", name);
  if (bytes.size() % 2 != 0) throw broken;
  const auto unit = [&](std::size_t i) {
    const auto low = static_cast<std::uint8_t>(bytes[i + (little_endian ? 0 : 1)]);
    const auto high = static_cast<std::uint8_t>(bytes[i + (little_endian ? 1 : 0)]);
    return static_cast<std::uint32_t>(low | (high << 8));
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code >= 0xD800U && code < 0xE000U) {  // the first of two units
      i += 2;
      const std::uint32_t second = i < bytes.size() ? unit(i) : 0;
      if (code >= 0xDC00U || second < 0xDC00U || second >= 0xE000U) throw broken;
      code = 0x10000U + ((code - 0xD800U) << 10U) + (second - 0xDC00U);
    }
    append_utf8(text, code);
  }
  return text;
}

}  // namespace

std::string read_text(const std::filesystem::path& path, std::size_t max_bytes) {
  std::string bytes = read_file(path, max_bytes);
  const std::string_view view = bytes;
  if (view.starts_with("\xEF\xBB\xBF")) return bytes.substr(3);
  const bool little_endian = view.starts_with("\xFF\xFE");
  if (!little_endian && !view.starts_with("\xFE\xFF")) return bytes;
  return from_utf16(view.substr(2), little_endian, path.string());
}

}  // namespace stillmap
