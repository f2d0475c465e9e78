// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <thread>

#include "stillmap/sensor/clock.hpp"

namespace stillmap {

/// The steady clock of the machine.
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
