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
/// The producer ends the stream with close(), or with fail() to hand its exception on. The consumer
/// may stop early with cancel(), after which push() returns false. Elements arrive in the order
/// they were pushed. Nothing polls and nothing is dropped.
template <class T>
class Channel {
 public:
  explicit Channel(std::size_t capacity) : capacity_(capacity) { STILLMAP_CHECK(capacity > 0); }

  /// Waits for room. False when the consumer has cancelled: the producer should stop.
  [[nodiscard]] bool push(T value) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return queue_.size() < capacity_ || cancelled_; });
    if (cancelled_) return false;
    queue_.push_back(std::move(value));
    changed_.notify_all();
    return true;
  }

  /// Waits for an element; nothing at the end of the stream. Throws what the producer failed with,
  /// after the elements that it pushed before.
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

  /// What is still in the queue is dropped.
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
