// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <future>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "tooling/view/view_server.hpp"

namespace stillmap {

class OpenPage;

/// The thread of a ViewServer with all that it works on. Members without another word are used by
/// that thread alone.
class ViewServing {
 public:
  ViewServing(const ViewAddress& address, ViewStart start);
  ~ViewServing();
  ViewServing(const ViewServing&) = delete;
  ViewServing& operator=(const ViewServing&) = delete;

  ViewInbox inbox;  ///< for any thread
  // For any thread but that of the server:
  void wake();
  void wait_until_alone();
  [[nodiscard]] const std::string& url() const { return url_; }

  // For connections and pages:
  /// What follows the token in a path; nothing for a path with another token or none.
  [[nodiscard]] std::optional<std::string_view> name_in(std::string_view path) const;
  [[nodiscard]] ViewState& state() { return state_; }
  void open(const std::shared_ptr<OpenPage>& page);
  void close(const std::shared_ptr<OpenPage>& page);
  /// Held by everything that has a connection.
  [[nodiscard]] std::shared_ptr<const char> ticket() const { return ticket_; }

 private:
  void accept();
  void read_inbox();
  void serve();
  void expect_alone(bool at_once);

  boost::asio::io_context context_{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> busy_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer farewell_, pause_;
  const std::string token_;
  const std::string url_;
  ViewState state_;
  std::set<std::shared_ptr<OpenPage>> pages_;
  std::shared_ptr<const char> ticket_ = std::make_shared<const char>();
  bool failed_ = false;
  std::promise<void>* alone_ = nullptr;  // of who waits
  std::thread thread_;
};

}  // namespace stillmap
