// SPDX-License-Identifier: Apache-2.0
#include "tooling/devices/stream_url.hpp"

#include <algorithm>
#include <string_view>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr std::string_view kScheme = "ws://";

[[noreturn]] void refuse(std::string_view scheme, const std::string& name) {
  if (scheme == "wss") {
    throw Error(
        "{}: encryption (wss) is not offered; expected stream:ws://HOST:PORT, a robot's rosbridge, "
        "where the network is not trusted through a tunnel (ssh -L)",
        name);
  }
  if (!scheme.empty()) {
    throw Error(
        "{}: {} is not offered, as video codecs carry no 16-bit depth; expected "
        "stream:ws://HOST:PORT, a robot's rosbridge",
        name,
        scheme);
  }
  throw Error("{}: expected stream:ws://HOST:PORT, a robot's rosbridge", name);
}

bool is_printable(char c) {
  return c > ' ' && c < '\x7F';
}

bool is_port(std::string_view text) {
  constexpr int kMostPort = 65535;
  const bool digits = !text.empty() && text.size() <= 5 &&
                      std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
  if (!digits) return false;
  const int port = std::stoi(std::string(text));
  return port >= 1 && port <= kMostPort;
}

}  // namespace

std::string StreamUrl::authority() const {
  const bool is_v6 = host.find(':') != std::string::npos;
  return (is_v6 ? "[" + host + "]" : host) + ":" + port;
}

StreamUrl parse_stream_url(const std::string& text, const std::string& name) {
  std::string_view rest = text;
  if (!rest.starts_with(kScheme)) {
    const std::size_t colon = rest.find("://");
    refuse(colon == std::string_view::npos ? std::string_view() : rest.substr(0, colon), name);
  }
  rest.remove_prefix(kScheme.size());
  if (!std::ranges::all_of(rest, is_printable)) refuse({}, name);
  StreamUrl url{{}, "9090", "/"};
  const std::size_t slash = std::min(rest.find_first_of("/?#"), rest.size());
  std::string_view place = rest.substr(0, slash);
  const std::string_view target = rest.substr(slash);
  if (!target.empty()) url.target = (target.front() == '/' ? "" : "/") + std::string(target);
  const bool bracketed = place.starts_with('[');
  const std::size_t end = bracketed ? place.find(']') : std::min(place.find(':'), place.size());
  if (end == std::string_view::npos) refuse({}, name);
  url.host = place.substr(bracketed ? 1 : 0, bracketed ? end - 1 : end);
  place.remove_prefix(end + (bracketed ? 1 : 0));
  if (url.host.empty() || url.host.find('@') != std::string::npos) refuse({}, name);
  if (place.empty()) return url;
  if (place.front() != ':' || !is_port(place.substr(1))) refuse({}, name);
  url.port = place.substr(1);
  return url;
}

}  // namespace stillmap
