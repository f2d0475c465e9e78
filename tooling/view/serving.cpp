// SPDX-License-Identifier: Apache-2.0
#if STILLMAP_WITH_VIEWER
#include "tooling/view/serving.hpp"

#include <chrono>
#include <exception>
#include <utility>

#include <boost/asio/ip/address.hpp>
#include <boost/asio/post.hpp>
#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "tooling/view/connection.hpp"

namespace stillmap {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr int kMostConnections = 64;
constexpr std::chrono::seconds kFarewell{3};

tcp::acceptor listening(asio::io_context& context, const ViewAddress& address) {
  const tcp::endpoint place(asio::ip::make_address(address.host), address.port);
  try {
    return tcp::acceptor(context, place);
  } catch (const boost::system::system_error& error) {
    throw Error("{}:{}: cannot be listened on: {}; give another address or port",
                address.host,
                address.port,
                error.code().message());
  }
}

std::string url_of(const tcp::endpoint& place, const std::string& token) {
  const std::string host = place.address().to_string();
  return fmt::format(
      "http://{}:{}/{}/", place.address().is_v6() ? '[' + host + ']' : host, place.port(), token);
}

}  // namespace

ViewServing::ViewServing(const ViewAddress& address, ViewStart start)
    : busy_(context_.get_executor()),
      acceptor_(listening(context_, address)),
      farewell_(context_),
      pause_(context_),
      token_(address.token.empty() ? random_token() : address.token),
      url_(url_of(acceptor_.local_endpoint(), token_)),
      state_(std::move(start)) {
  accept();
  thread_ = std::thread([this] { serve(); });
}

ViewServing::~ViewServing() {
  context_.stop();
  thread_.join();
}

void ViewServing::wake() {
  asio::post(context_, [this] { read_inbox(); });
}

void ViewServing::wait_until_alone() {
  std::promise<void> alone;
  asio::post(context_, [this, &alone] {
    alone_ = &alone;
    expect_alone(true);
  });
  alone.get_future().wait();
}

std::optional<std::string_view> ViewServing::name_in(std::string_view path) const {
  if (path.size() < token_.size() + 2 || path.front() != '/') return std::nullopt;
  if (!same_token(path.substr(1, token_.size()), token_)) return std::nullopt;
  if (path[token_.size() + 1] != '/') return std::nullopt;
  return path.substr(token_.size() + 2);
}

void ViewServing::open(const std::shared_ptr<OpenPage>& page) {
  pages_.insert(page);
  farewell_.cancel();
}

void ViewServing::close(const std::shared_ptr<OpenPage>& page) {
  pages_.erase(page);
  expect_alone(false);
}

void ViewServing::expect_alone(bool at_once) {
  if (alone_ == nullptr || !pages_.empty()) return;
  farewell_.expires_after(at_once ? std::chrono::seconds(0) : kFarewell);
  farewell_.async_wait([this](error_code error) {
    if (error || !pages_.empty()) return;
    std::exchange(alone_, nullptr)->set_value();
  });
}

void ViewServing::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (error) {  // no descriptor is left, for example
      pause_.expires_after(std::chrono::seconds(1));
      pause_.async_wait([this](error_code) { accept(); });
      return;
    }
    if (ticket_.use_count() <= kMostConnections) {
      std::make_shared<Connection>(std::move(socket), *this)->read();
    }
    accept();
  });
}

void ViewServing::read_inbox() {
  ViewInbox::Contents news = inbox.take();
  if (failed_) return;
  state_.apply(std::move(news));
  for (const std::shared_ptr<OpenPage>& page : pages_) page->answer();
}

// What fails here costs the view, never the run.
void ViewServing::serve() {
  for (;;) {
    try {
      context_.run();
      return;
    } catch (const std::exception&) {
      failed_ = true;
      pages_.clear();
      expect_alone(true);
    }
  }
}

}  // namespace stillmap
#endif
