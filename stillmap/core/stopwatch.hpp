// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace stillmap {

/// Measures wall-clock time. For reports only: no result depends on it.
class Stopwatch {
 public:
  /// Milliseconds since the last lap, or since construction.
  double lap_ms() {
    const Clock::time_point now = Clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace stillmap
