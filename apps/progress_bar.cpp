// SPDX-License-Identifier: Apache-2.0
#include "apps/progress_bar.hpp"

#include <fmt/core.h>
#include <unistd.h>

namespace stillmap {

ProgressBar::ProgressBar(std::string unit)
    : unit_(std::move(unit)), on_terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  finish();
}

void ProgressBar::show(std::size_t done, std::size_t total) {
  if (!on_terminal_ || total == 0) return;
  const int percent = static_cast<int>(100 * done / total);
  if (percent == shown_percent_) return;
  shown_percent_ = percent;
  constexpr int kWidth = 40;
  const std::string filled(static_cast<std::size_t>(kWidth * percent / 100), '#');
  fmt::print(stderr, "\r[{:<{}}] {:>3} %  {}/{} {}", filled, kWidth, percent, done, total, unit_);
}

void ProgressBar::say(const std::string& line) const {
  if (on_terminal_) fmt::print(stderr, "{}\n", line);
}

void ProgressBar::warn(const std::string& warning) {
  finish();
  fmt::print(stderr, "stillmap: warning: {}\n", warning);
}

void ProgressBar::finish() {
  if (shown_percent_ < 0) return;
  fmt::print(stderr, "\r\033[K");
  shown_percent_ = -1;
}

}  // namespace stillmap
