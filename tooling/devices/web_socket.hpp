// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "tooling/devices/stream_url.hpp"

namespace stillmap {

/// A connection to a WebSocket server (RFC 6455), for one thread. Nothing happens but in receive()
/// and wait().
class WebSocketClient {
 public:
  using Time = std::chrono::steady_clock::time_point;
  enum class State { kConnecting, kOpen, kLost };
  struct Message {
    std::string_view bytes;  ///< until the next call
    bool binary = false;
  };

  /// Larger messages are refused before they are read: the connection is lost.
  static constexpr std::size_t kMaxMessageBytes = std::size_t{64} << 20U;

  /// Is lost at first, until connect().
  explicit WebSocketClient(StreamUrl url);
  WebSocketClient(const WebSocketClient&) = delete;
  WebSocketClient& operator=(const WebSocketClient&) = delete;
  ~WebSocketClient();

  /// Begins to connect; what was open before goes. It is lost where that takes more than 5 s, and
  /// later where the server does not answer for 10 s.
  void connect();
  [[nodiscard]] State state() const;
  /// Why it is lost.
  [[nodiscard]] const std::string& problem() const;
  /// Whether it is lost because a message was too large.
  [[nodiscard]] bool refused_message() const;

  /// Sends a text after those before it, while somebody waits. To be called while it is open.
  void send(std::string text);
  /// The next message; waits for it until then. Nothing where none came or the connection is lost.
  /// A message that has arrived is given whatever the time is.
  [[nodiscard]] std::optional<Message> receive(Time until);
  /// Returns at that time, or when the state changes.
  void wait(Time until);

 private:
  class Connection;
  class Loop;
  StreamUrl url_;
  std::unique_ptr<Loop> loop_;
  std::shared_ptr<Connection> connection_;
};

}  // namespace stillmap
