// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace stillmap {

/// What a live run goes by. The library never waits for time to pass by itself: whoever runs it
/// live brings the clock.
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

}  // namespace stillmap
