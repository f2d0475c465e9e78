// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>

#include "stillmap/core/error.hpp"

namespace stillmap {

/// A bounded queue between one producing and one consuming thread, with an explicit end.
///
/// The producer ends the queue with close(), or with fail() to pass on its exception. The consumer
/// may stop early with cancel(), after which push() returns false. Elements arrive in the order in
/// which they were pushed. Threads wait without polling; only cancel() drops elements.
template <class T>
class Channel {
 public:
  explicit Channel(std::size_t capacity) : capacity_(capacity) { STILLMAP_CHECK(capacity > 0); }

  /// Waits for room. Returns false when the consumer has cancelled: the producer should stop.
  [[nodiscard]] bool push(T value) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return queue_.size() < capacity_ || cancelled_; });
    if (cancelled_) return false;
    queue_.push_back(std::move(value));
    changed_.notify_all();
    return true;
  }

  /// Waits for an element and returns it; returns nothing at the end. If the producer has failed,
  /// throws its exception once the elements pushed before are taken.
  [[nodiscard]] std::optional<T> pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !queue_.empty() || closed_; });
    if (queue_.empty()) {
      if (failure_) std::rethrow_exception(failure_);
      return std::nullopt;
    }
    T value = std::move(queue_.front());
    queue_.pop_front();
    changed_.notify_all();
    return value;
  }

  void close() { finish(nullptr); }
  void fail(std::exception_ptr failure) { finish(std::move(failure)); }

  /// Drops the elements still in the queue.
  void cancel() {
    const std::lock_guard lock(mutex_);
    cancelled_ = true;
    queue_.clear();
    changed_.notify_all();
  }

 private:
  void finish(std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    failure_ = std::move(failure);
    changed_.notify_all();
  }

  std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<T> queue_;
  bool closed_ = false;
  bool cancelled_ = false;
  std::exception_ptr failure_;
};

}  // namespace stillmap
