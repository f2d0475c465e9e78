// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace stillmap {

/// A progress line on standard error; silent if that is no terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::string unit);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(std::size_t done, std::size_t total);
  /// Prints a separate line on a terminal.
  void say(const std::string& line) const;
  /// Prints a separate line, even without a terminal.
  void warn(const std::string& warning);
  /// Clears the progress line.
  void finish();

 private:
  std::string unit_;
  bool on_terminal_;
  int shown_percent_ = -1;
};

}  // namespace stillmap
