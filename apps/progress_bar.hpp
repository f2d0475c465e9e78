// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace stillmap {

/// A line on standard error that shows how far long work is; silent where that is no terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::string unit);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(std::size_t done, std::size_t total);
  /// A line of its own, also where there is no terminal.
  void warn(const std::string& warning);
  /// Clears the line.
  void finish();

 private:
  std::string unit_;
  bool on_terminal_;
  int shown_percent_ = -1;
};

}  // namespace stillmap
