// SPDX-License-Identifier: Apache-2.0
#include "apps/viewer_option.hpp"

#include <utility>

#include <fmt/core.h>

#include "apps/commands.hpp"
#include "apps/interruption.hpp"
#include "apps/option_value.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {

CLI::Option* add_view_address(CLI::App& command, ViewerArguments& arguments) {
  return command.add_option(
      "--view-address",
      arguments.address,
      "HOST:PORT of the page, instead of a free port that this machine alone can reach; "
      "HOST:PORT/TOKEN for an address that stays the same");
}

void add_view_options(CLI::App& command, ViewerArguments& arguments) {
  CLI::Option* view = command.add_flag(
      "--view", arguments.view, "show the run in a browser, at the address that is printed");
  add_view_address(command, arguments)->needs(view);
}

std::unique_ptr<ViewServer> serve_view(const ViewerArguments& arguments, ViewStart start) {
  if (const std::string lacks = viewer_lacks(); !lacks.empty()) {
    throw Error("--view: this build has no view in a browser: install {} and build again", lacks);
  }
  ViewAddress address;
  if (!arguments.address.empty()) {
    address = option_value("--view-address", arguments.address, parse_view_address);
  }
  auto server = std::make_unique<ViewServer>(address, std::move(start));
  print_output(fmt::format("view        {}\n", server->url()));
  return server;
}

RunViewer::RunViewer(const ViewerArguments& arguments, ViewStart start) {
  if (!arguments.view) return;
  const CameraModel camera = start.camera.value();
  server_ = serve_view(arguments, std::move(start));
  observer_.emplace(*server_, camera);
}

void RunViewer::stay() {
  if (!server_) return;
  note_no_interruption();
  server_->wait_until_alone();
}

}  // namespace stillmap
