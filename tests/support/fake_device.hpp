// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/sensor/clock.hpp"
#include "tooling/devices/device.hpp"

namespace stillmap {

/// A clock that several threads may read; it advances only when somebody waits or a test says so.
class SharedClock : public Clock {
 public:
  [[nodiscard]] double now_s() override { return now_s_; }
  void wait_until_s(double time_s) override {
    if (time_s > now_s_) now_s_ = time_s;
  }
  void pass_s(double seconds) { now_s_ = now_s_ + seconds; }

 private:
  std::atomic<double> now_s_ = 500;
};

/// A device that does what a test has written down: it gives images at their times, or none.
class FakeDevice : public Device {
 public:
  /// One thing that happens, `after_s` after the thing before it.
  struct Event {
    double after_s = 0;
    std::optional<DeviceImages> images = {};  ///< nothing: the device begins anew, its clock, too
    std::string error = {};                   ///< not empty: it fails for good
  };

  FakeDevice(Clock& clock, std::deque<Event> events, std::optional<CameraModel> camera)
      : clock_(clock), events_(std::move(events)), camera_(std::move(camera)) {}

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] std::optional<CameraModel> camera() const override { return camera_; }
  [[nodiscard]] bool ended() const override { return events_.empty() && ends_; }

  [[nodiscard]] std::optional<DeviceImages> wait(double timeout_s) override {
    const double until_s = clock_.now_s() + timeout_s;
    if (!next_s_ && !events_.empty()) next_s_ = clock_.now_s() + events_.front().after_s;
    if (events_.empty() || *next_s_ > until_s) {
      clock_.wait_until_s(until_s);
      return std::nullopt;
    }
    clock_.wait_until_s(*next_s_);
    Event event = std::move(events_.front());
    events_.pop_front();
    next_s_.reset();
    if (!event.error.empty()) throw Error("{}", event.error);
    return std::move(event.images);
  }

  /// It is never at its end: without events it gives no images.
  void go_on() { ends_ = false; }

 private:
  Clock& clock_;
  std::deque<Event> events_;
  std::optional<CameraModel> camera_;
  std::optional<double> next_s_;  // when the first event happens, by the clock
  std::string name_ = "fake:0";
  bool ends_ = true;
};

}  // namespace stillmap
