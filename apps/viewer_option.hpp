// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "tooling/view/view_observer.hpp"
#include "tooling/view/view_server.hpp"

namespace stillmap {

struct ViewerArguments {
  bool view = false;
  std::string address;  ///< empty: any free port of this machine, for itself alone
};

/// Adds --view-address.
CLI::Option* add_view_address(CLI::App& command, ViewerArguments& arguments);
/// Adds --view and --view-address.
void add_view_options(CLI::App& command, ViewerArguments& arguments);

/// Begins to serve pages and prints their address. Throws Error naming --view or --view-address
/// where that cannot be.
[[nodiscard]] std::unique_ptr<ViewServer> serve_view(const ViewerArguments& arguments,
                                                     ViewStart start);

/// A run that can be looked at, if that was asked for.
class RunViewer {
 public:
  RunViewer(const ViewerArguments& arguments, ViewStart start);

  /// Null without a view.
  [[nodiscard]] Observer* observer() { return observer_ ? &*observer_ : nullptr; }
  /// Stays as long as a page is open. Ctrl-C ends the program, whose results are whole by then.
  void stay();

 private:
  std::unique_ptr<ViewServer> server_;
  std::optional<ViewObserver> observer_;
};

}  // namespace stillmap
