// SPDX-License-Identifier: Apache-2.0
#include "apps/interruption.hpp"

#include <csignal>

#include <fmt/core.h>

namespace stillmap {
namespace {

// A signal handler can reach nothing but global variables.
std::atomic<bool> interruption = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

extern "C" void on_signal(int) {
  interruption = true;
  // NOLINTBEGIN(cert-err33-c): it cannot fail for these signals.
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  // NOLINTEND(cert-err33-c)
}

// A signal that whoever started the program has it ignore stays ignored.
void handle(int signal_number) {
  struct sigaction before = {};
  if (sigaction(signal_number, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) return;
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;  // reads and writes go on
  sigemptyset(&action.sa_mask);
  sigaction(signal_number, &action, nullptr);
}

}  // namespace

void note_interruption() {
  interruption = false;
  handle(SIGINT);
  handle(SIGTERM);
}

bool interruption_noted() {
  return interruption;
}

std::optional<std::size_t> InterruptibleStream::size() const {
  return ended_early_ ? std::optional<std::size_t>(frames_) : stream_.size();
}

std::string InterruptibleStream::interruption() const {
  if (!ended_early_) return {};
  const std::optional<std::size_t> total = stream_.size();
  return fmt::format("interrupted after {}{} frames: the results are of these",
                     frames_.load(),
                     total ? fmt::format(" of {}", *total) : "");
}

std::optional<StreamedFrame> InterruptibleStream::next() {
  if (interruption_noted()) {
    const std::optional<std::size_t> total = stream_.size();
    ended_early_ = !total || frames_ < *total;
    return std::nullopt;
  }
  std::optional<StreamedFrame> frame = stream_.next();
  if (frame) ++frames_;
  return frame;
}

}  // namespace stillmap
