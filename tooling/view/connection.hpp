// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "tooling/view/serving.hpp"

namespace stillmap {

/// One request of a browser: a file, or the socket of a page.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(boost::asio::ip::tcp::socket socket, ViewServing& serving);
  void read();

 private:
  using Answer = boost::beast::http::response<boost::beast::http::string_body>;
  void answer();
  void send(Answer answer);

  boost::beast::tcp_stream stream_;
  ViewServing& serving_;
  std::shared_ptr<const char> ticket_;
  boost::beast::flat_buffer buffer_;
  boost::beast::http::request_parser<boost::beast::http::empty_body> parser_;
  Answer answer_;
};

/// A page with its socket: it asks, and gets the next message as soon as there is one.
class OpenPage : public std::enable_shared_from_this<OpenPage> {
 public:
  OpenPage(boost::beast::tcp_stream stream, ViewServing& serving);
  void begin(const boost::beast::http::request<boost::beast::http::empty_body>& request);
  /// Sends the next message if the page has asked for one and lacks anything.
  void answer();

 private:
  void read();
  void leave();

  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  ViewServing& serving_;
  std::shared_ptr<const char> ticket_;
  boost::beast::flat_buffer asked_;
  PageProgress progress_;
  bool asks_ = false, sending_ = false;
  std::string message_;  // being sent
};

}  // namespace stillmap
