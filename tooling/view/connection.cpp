// SPDX-License-Identifier: Apache-2.0
#if STILLMAP_WITH_VIEWER
#include "tooling/view/connection.hpp"

#include <chrono>
#include <optional>
#include <string_view>

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "tooling/view/page_files.hpp"

namespace stillmap {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;

constexpr std::size_t kLargestHead = 16 * 1024;
constexpr std::size_t kLargestQuestion = 64;
constexpr std::chrono::seconds kPatience{20};

std::string_view text_of(beast::string_view text) {
  return {text.data(), text.size()};
}

}  // namespace

Connection::Connection(boost::asio::ip::tcp::socket socket, ViewServing& serving)
    : stream_(std::move(socket)),
      serving_(serving),
      ticket_(serving.ticket()),
      buffer_(kLargestHead) {}

void Connection::read() {
  parser_.header_limit(kLargestHead);
  stream_.expires_after(kPatience);
  http::async_read(
      stream_, buffer_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
        if (!error) self->answer();
      });
}

void Connection::answer() {
  const auto& request = parser_.get();
  const std::optional<std::string_view> name = serving_.name_in(text_of(request.target()));
  Answer answer{http::status::ok, request.version()};
  if (!name) {
    answer.result(http::status::forbidden);
    answer.body() = "No token: take the whole address that stillmap has printed.\n";
  } else if (request.method() != http::verb::get) {
    answer.result(http::status::method_not_allowed);
  } else if (*name == "socket" && websocket::is_upgrade(request)) {
    std::make_shared<OpenPage>(std::move(stream_), serving_)->begin(request);
    return;
  } else if (const std::optional<PageFile> file = page_file(*name)) {
    answer.set(http::field::content_type, beast::string_view(file->type.data(), file->type.size()));
    answer.body() = file->text;
  } else {
    answer.result(http::status::not_found);
  }
  send(std::move(answer));
}

void Connection::send(Answer answer) {
  answer_ = std::move(answer);
  answer_.keep_alive(false);
  answer_.set(http::field::cache_control, "no-store");
  answer_.set("Content-Security-Policy",
              "default-src 'self'; img-src 'self' blob: data:; frame-ancestors 'none'");
  answer_.set("Referrer-Policy", "no-referrer");
  answer_.set("X-Content-Type-Options", "nosniff");
  answer_.prepare_payload();
  http::async_write(stream_, answer_, [self = shared_from_this()](error_code, std::size_t) {
    error_code ignored;
    self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  });
}

OpenPage::OpenPage(beast::tcp_stream stream, ViewServing& serving)
    : socket_(std::move(stream)),
      serving_(serving),
      ticket_(serving.ticket()),
      asked_(kLargestQuestion) {}

void OpenPage::begin(const http::request<http::empty_body>& request) {
  beast::get_lowest_layer(socket_).expires_never();  // the socket has limits of its own
  websocket::stream_base::timeout limits{};
  limits.handshake_timeout = kPatience;
  limits.idle_timeout = kPatience;
  limits.keep_alive_pings = true;
  socket_.set_option(limits);
  socket_.read_message_max(kLargestQuestion);
  socket_.binary(true);
  socket_.auto_fragment(false);  // a message is written as a whole anyway
  socket_.async_accept(request, [self = shared_from_this()](error_code error) {
    if (error) return;
    self->serving_.open(self);
    self->read();
  });
}

void OpenPage::read() {
  socket_.async_read(asked_, [self = shared_from_this()](error_code error, std::size_t size) {
    if (error) return self->leave();
    self->asked_.consume(size);
    self->asks_ = true;
    self->answer();
    self->read();
  });
}

void OpenPage::answer() {
  if (!asks_ || sending_) return;
  message_ = serving_.state().next_message(progress_);
  if (message_.empty()) return;
  asks_ = false;
  sending_ = true;
  socket_.async_write(boost::asio::buffer(message_),
                      [self = shared_from_this()](error_code error, std::size_t) {
                        self->sending_ = false;
                        if (!error) self->answer();
                      });
}

void OpenPage::leave() {
  serving_.close(shared_from_this());
}

}  // namespace stillmap
#endif
