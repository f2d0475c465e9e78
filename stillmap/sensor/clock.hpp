// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace stillmap {

/// The clock of a live run. The library has no clock of its own: the caller of a live run provides
/// it.
class Clock {
 public:
  Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  virtual ~Clock() = default;

  /// Seconds since a fixed time; never decreases.
  [[nodiscard]] virtual double now_s() = 0;
  virtual void wait_until_s(double time_s) = 0;
};

}  // namespace stillmap
