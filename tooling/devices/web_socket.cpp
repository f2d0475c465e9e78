// SPDX-License-Identifier: Apache-2.0
#if STILLMAP_WITH_BEAST
#include "tooling/devices/web_socket.hpp"

#include <deque>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/error.hpp>
#include <boost/beast/websocket/stream.hpp>

namespace stillmap {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::chrono::seconds kConnecting{5}, kSilence{10};

}  // namespace

class WebSocketClient::Loop {
 public:
  asio::io_context context{1};
  asio::steady_timer timer{context};
};

/// One attempt with what comes of it. Its handlers hold it, so that it outlives what was begun.
class WebSocketClient::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(asio::io_context& context, const StreamUrl& url)
      : url_(url),
        resolver_(context),
        limit_(context),
        socket_(context),
        buffer_(kMaxMessageBytes) {}

  void begin() {
    limit_.expires_after(kConnecting);
    limit_.async_wait([self = shared_from_this()](error_code error) {
      if (!error && self->state == State::kConnecting) self->lose("no answer within 5 s");
    });
    resolver_.async_resolve(
        url_.host,
        url_.port,
        [self = shared_from_this()](error_code error, const tcp::resolver::results_type& found) {
          if (self->went_well(error)) self->connect(found);
        });
  }

  void read() {
    if (reading_ || has_message || state != State::kOpen) return;
    buffer_.clear();
    reading_ = true;
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      self->reading_ = false;
      self->has_message = self->went_well(error);
    });
  }

  [[nodiscard]] Message take() {
    has_message = false;
    const auto bytes = buffer_.cdata();
    return {{static_cast<const char*>(bytes.data()), bytes.size()}, socket_.got_binary()};
  }

  void send(std::string text) {
    waiting_.push_back(std::move(text));
    if (waiting_.size() == 1) write();
  }

  // Ends it with what was begun.
  void lose(std::string why) {
    if (state == State::kLost) return;
    state = State::kLost;
    problem = std::move(why);
    limit_.cancel();
    resolver_.cancel();
    beast::get_lowest_layer(socket_).close();
  }

  State state = State::kConnecting;
  std::string problem;
  bool has_message = false, refused = false;

 private:
  [[nodiscard]] bool went_well(error_code error) {
    if (state == State::kLost) return false;
    if (!error) return true;
    refused =
        error == websocket::error::message_too_big || error == websocket::error::buffer_overflow;
    lose(refused ? "a message of more than 64 MiB" : error.message());
    return false;
  }

  void connect(const tcp::resolver::results_type& found) {
    beast::get_lowest_layer(socket_).async_connect(
        found, [self = shared_from_this()](error_code error, const tcp::endpoint&) {
          if (self->went_well(error)) self->shake_hands();
        });
  }

  void shake_hands() {
    websocket::stream_base::timeout limits{};
    limits.handshake_timeout = kConnecting;
    limits.idle_timeout = kSilence;
    limits.keep_alive_pings = true;
    socket_.set_option(limits);
    socket_.read_message_max(kMaxMessageBytes);
    socket_.async_handshake(
        url_.authority(), url_.target, [self = shared_from_this()](error_code error) {
          if (!self->went_well(error)) return;
          self->limit_.cancel();
          self->state = State::kOpen;
        });
  }

  void write() {
    socket_.text(true);
    socket_.async_write(asio::buffer(waiting_.front()),
                        [self = shared_from_this()](error_code error, std::size_t) {
                          if (!self->went_well(error)) return;
                          self->waiting_.pop_front();
                          if (!self->waiting_.empty()) self->write();
                        });
  }

  StreamUrl url_;
  tcp::resolver resolver_;
  asio::steady_timer limit_;
  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  std::deque<std::string> waiting_;  // the first is being written
  bool reading_ = false;
};

WebSocketClient::WebSocketClient(StreamUrl url)
    : url_(std::move(url)), loop_(std::make_unique<Loop>()) {}

WebSocketClient::~WebSocketClient() {
  if (connection_) connection_->lose({});
  connection_.reset();
}

void WebSocketClient::connect() {
  if (connection_) connection_->lose({});
  connection_ = std::make_shared<Connection>(loop_->context, url_);
  connection_->begin();
}

WebSocketClient::State WebSocketClient::state() const {
  return connection_ ? connection_->state : State::kLost;
}

const std::string& WebSocketClient::problem() const {
  static const std::string kNever = "not connected";
  return connection_ ? connection_->problem : kNever;
}

bool WebSocketClient::refused_message() const {
  return connection_ && connection_->refused;
}

void WebSocketClient::send(std::string text) {
  connection_->send(std::move(text));
}

std::optional<WebSocketClient::Message> WebSocketClient::receive(Time until) {
  if (!connection_) return std::nullopt;
  connection_->read();
  while (!connection_->has_message && connection_->state == State::kOpen) {
    loop_->context.restart();
    const bool in_time = Time::clock::now() < until;
    const std::size_t done =
        in_time ? loop_->context.run_one_until(until) : loop_->context.poll_one();
    if (done == 0) return std::nullopt;
  }
  if (!connection_->has_message) return std::nullopt;
  return connection_->take();
}

void WebSocketClient::wait(Time until) {
  bool over = false;
  loop_->timer.expires_at(until);
  loop_->timer.async_wait([&over](error_code) { over = true; });
  const State before = state();
  while (!over && state() == before) {
    loop_->context.restart();
    loop_->context.run_one();
  }
  loop_->timer.cancel();
  // The handler is called before `over` goes.
  while (!over) {
    loop_->context.restart();
    loop_->context.run_one();
  }
}

}  // namespace stillmap
#endif
