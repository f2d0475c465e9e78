// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

namespace stillmap {

/// Hands values from one producing to one consuming thread. Only the newest waits: it takes the
/// place of an older one that nobody has taken, and the producer never waits.
template <class T>
class Newest {
 public:
  struct Taken {
    T value;
    std::size_t replaced;  ///< values before it that nobody has taken
  };

  /// Returns false when the consumer has cancelled: the producer should stop.
  [[nodiscard]] bool put(T value) {
    const std::lock_guard lock(mutex_);
    if (cancelled_) return false;
    if (value_) ++replaced_;
    value_ = std::move(value);
    changed_.notify_all();
    return true;
  }

  /// Waits for a value and returns it; returns nothing at the end. If the producer has failed,
  /// throws its exception once the last value is taken.
  [[nodiscard]] std::optional<Taken> take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return value_ || ended_; });
    if (!value_) {
      if (failure_) std::rethrow_exception(failure_);
      return std::nullopt;
    }
    Taken taken{*std::exchange(value_, std::nullopt), std::exchange(replaced_, 0)};
    return taken;
  }

  /// The producer gives no more values; `failure`: because of this exception.
  void end(std::exception_ptr failure = nullptr) {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    failure_ = std::move(failure);
    changed_.notify_all();
  }

  /// The consumer takes no more values.
  void cancel() {
    const std::lock_guard lock(mutex_);
    cancelled_ = true;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<T> value_;
  std::size_t replaced_ = 0;
  std::exception_ptr failure_;
  bool ended_ = false;
  bool cancelled_ = false;
};

}  // namespace stillmap
