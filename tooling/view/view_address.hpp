// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace stillmap {

/// Where pages are served.
struct ViewAddress {
  std::string host = "127.0.0.1";  ///< an IP address of this machine
  std::uint16_t port = 0;          ///< 0: any free one
  std::string token;               ///< the first part of every path; empty: a random one
};

/// Reads HOST:PORT or HOST:PORT/TOKEN, where HOST is an IP address ([...] around one of version 6)
/// or localhost, and TOKEN has 16 to 64 letters, digits, '-' or '_'. Throws Error beginning with
/// the text.
[[nodiscard]] ViewAddress parse_view_address(const std::string& text);

/// 128 bits of the system's random numbers, as 32 hexadecimal digits.
[[nodiscard]] std::string random_token();

/// Whether two tokens are equal, in a time that does not depend on where they differ.
[[nodiscard]] bool same_token(std::string_view a, std::string_view b);

}  // namespace stillmap
