// SPDX-License-Identifier: Apache-2.0
#include "tooling/view/view_address.hpp"

#include <algorithm>
#include <charconv>
#include <random>

#include <arpa/inet.h>
#include <fmt/core.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kShortestToken = 16, kLongestToken = 64;

bool is_token(std::string_view text) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  };
  return text.size() >= kShortestToken && text.size() <= kLongestToken &&
         std::ranges::all_of(text, allowed);
}

bool is_ip_address(const std::string& text) {
  in6_addr bytes{};  // large enough for both
  return inet_pton(AF_INET, text.c_str(), &bytes) == 1 ||
         inet_pton(AF_INET6, text.c_str(), &bytes) == 1;
}

}  // namespace

ViewAddress parse_view_address(const std::string& text) {
  const auto refuse = [&] {
    throw Error(
        "{}: expected HOST:PORT or HOST:PORT/TOKEN, such as 127.0.0.1:8080, with an IP address of "
        "this machine and a token of 16 to 64 letters and digits",
        text);
  };
  const std::size_t slash = text.find('/');
  const std::string place = text.substr(0, slash);
  const std::size_t colon = place.rfind(':');
  if (colon == std::string::npos) refuse();
  ViewAddress address;
  address.host = place.substr(0, colon);
  if (address.host == "localhost") address.host = "127.0.0.1";
  if (address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']') {
    address.host = address.host.substr(1, address.host.size() - 2);
  }
  const char* const end = place.data() + place.size();
  const auto [stop, error] = std::from_chars(place.data() + colon + 1, end, address.port);
  if (error != std::errc() || stop != end || !is_ip_address(address.host)) refuse();
  if (slash == std::string::npos) return address;
  address.token = text.substr(slash + 1);
  if (!is_token(address.token)) refuse();
  return address;
}

std::string random_token() {
  std::random_device system;  // of the processor or the kernel
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", system());
  return token;
}

bool same_token(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  }
  return difference == 0;
}

}  // namespace stillmap
