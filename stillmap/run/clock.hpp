// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <thread>

namespace stillmap {

/// The time of day of a live run; tests have their own.
class Clock {
 public:
  Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  virtual ~Clock() = default;

  /// Seconds since some moment; never goes back.
  [[nodiscard]] virtual double now_s() = 0;
  virtual void wait_until_s(double time_s) = 0;
};

/// The machine's.
class SteadyClock : public Clock {
 public:
  [[nodiscard]] double now_s() override {
    return std::chrono::duration<double>(Steady::now().time_since_epoch()).count();
  }
  void wait_until_s(double time_s) override {
    std::this_thread::sleep_until(Steady::time_point(
        std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(time_s))));
  }

 private:
  using Steady = std::chrono::steady_clock;
};

}  // namespace stillmap
