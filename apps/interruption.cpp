// SPDX-License-Identifier: Apache-2.0
#include "apps/interruption.hpp"

#include <atomic>
#include <csignal>

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

void note_no_interruption() {
  for (const int signal_number : {SIGINT, SIGTERM}) {
    struct sigaction present = {};
    if (sigaction(signal_number, nullptr, &present) == 0 && present.sa_handler == on_signal) {
      std::signal(signal_number, SIG_DFL);  // NOLINT(cert-err33-c): it cannot fail here
    }
  }
}

bool interruption_noted() {
  return interruption;
}

}  // namespace stillmap
