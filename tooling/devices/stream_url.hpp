// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace stillmap {

/// Where a WebSocket is.
struct StreamUrl {
  std::string host;    ///< a name or an address, without brackets
  std::string port;    ///< a number
  std::string target;  ///< begins with a slash

  /// Host and port as a request names them.
  [[nodiscard]] std::string authority() const;
};

/// Reads "ws://HOST", with ":PORT" (9090, rosbridge's, where it is missing) and "/PATH". Throws
/// Error, beginning with `name`, for anything else, and says what is offered.
[[nodiscard]] StreamUrl parse_stream_url(const std::string& text, const std::string& name);

}  // namespace stillmap
