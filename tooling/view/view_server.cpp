// SPDX-License-Identifier: Apache-2.0
#include "tooling/view/view_server.hpp"

#include "stillmap/core/error.hpp"

#if STILLMAP_WITH_VIEWER
#include "tooling/view/serving.hpp"
#endif

namespace stillmap {

#if STILLMAP_WITH_VIEWER

std::string viewer_lacks() {
  return {};
}

#else

std::string viewer_lacks() {
  return STILLMAP_VIEWER_LACKS;
}

class ViewServing {
 public:
  ViewServing(const ViewAddress&, ViewStart) {
    throw Error("this build shows no view in a browser: install {} and build again",
                viewer_lacks());
  }
  ViewInbox inbox;
  void wake() {}
  void wait_until_alone() {}
  [[nodiscard]] std::string url() const { return {}; }
};

#endif

ViewServer::ViewServer(const ViewAddress& address, ViewStart start)
    : serving_(std::make_unique<ViewServing>(address, std::move(start))), url_(serving_->url()) {}

ViewServer::~ViewServer() = default;

ViewInbox& ViewServer::inbox() {
  return serving_->inbox;
}

void ViewServer::wake() {
  serving_->wake();
}

void ViewServer::wait_until_alone() {
  serving_->wait_until_alone();
}

}  // namespace stillmap
