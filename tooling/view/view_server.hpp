// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "tooling/view/inbox.hpp"
#include "tooling/view/view_address.hpp"
#include "tooling/view/view_state.hpp"

namespace stillmap {

class ViewServing;

/// What this build lacks for serving pages, as packages to install; empty if nothing.
[[nodiscard]] std::string viewer_lacks();

/// Serves pages that show what is put into its inbox. One thread of its own does everything:
/// connections, messages, pictures. A page asks for each message, so that one that is slow or gone
/// costs nothing. Requests whose path does not begin with the token are refused.
class ViewServer {
 public:
  /// Listens. Throws Error where it cannot, or where the build lacks what viewer_lacks() says.
  ViewServer(const ViewAddress& address, ViewStart start);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  /// The page's address, with port and token.
  [[nodiscard]] const std::string& url() const { return url_; }

  /// What pages are to show; wake() after a put that returned true.
  [[nodiscard]] ViewInbox& inbox();
  void wake();

  /// Returns when no page is open: at once if none is, else three seconds after the last one left,
  /// so that it may be loaded again.
  void wait_until_alone();

 private:
  std::unique_ptr<ViewServing> serving_;
  std::string url_;
};

}  // namespace stillmap
