// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include <OpenNI.h>

namespace stillmap {

using SteadyTime = std::chrono::steady_clock::time_point;

/// "1d27/0601" of "1d27/0601@1/5": what a device is, without where it is plugged in.
[[nodiscard]] inline std::string_view kind_of(std::string_view uri) {
  return uri.substr(0, uri.find('@'));
}

/// Notes when a device is plugged in or out. The library calls it on threads of its own.
class Plug : public openni::OpenNI::DeviceConnectedListener,
             public openni::OpenNI::DeviceDisconnectedListener {
 public:
  explicit Plug(std::string uri) : uri_(std::move(uri)) {
    openni::OpenNI::addDeviceConnectedListener(this);
    openni::OpenNI::addDeviceDisconnectedListener(this);
  }
  Plug(const Plug&) = delete;
  Plug& operator=(const Plug&) = delete;
  ~Plug() {
    openni::OpenNI::removeDeviceConnectedListener(this);
    openni::OpenNI::removeDeviceDisconnectedListener(this);
  }

  [[nodiscard]] std::string uri() const {
    const std::lock_guard lock(mutex_);
    return uri_;
  }
  [[nodiscard]] bool plugged_in() const {
    const std::lock_guard lock(mutex_);
    return plugged_in_;
  }
  /// Returns whether it is plugged in by then.
  [[nodiscard]] bool wait_until(SteadyTime time) {
    std::unique_lock lock(mutex_);
    return changed_.wait_until(lock, time, [&] { return plugged_in_; });
  }
  /// Returns when it is plugged in or out, or at that time.
  void wait_for_change(SteadyTime time) {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, time, [this, before = plugged_in_] { return plugged_in_ != before; });
  }

 private:
  void onDeviceConnected(const openni::DeviceInfo* device) override {
    const std::lock_guard lock(mutex_);
    if (plugged_in_ || kind_of(device->getUri()) != kind_of(uri_)) return;
    uri_ = device->getUri();
    plugged_in_ = true;
    changed_.notify_all();
  }
  void onDeviceDisconnected(const openni::DeviceInfo* device) override {
    const std::lock_guard lock(mutex_);
    if (uri_ != device->getUri()) return;
    plugged_in_ = false;
    changed_.notify_all();
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::string uri_;
  bool plugged_in_ = true;
};

}  // namespace stillmap
