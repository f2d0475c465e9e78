// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include "stillmap/concurrency/channel.hpp"

namespace stillmap {

/// Gives the items that a function returns, call by call, until it returns nothing. The function is
/// called ahead on a thread of its own, or only on demand. Both give the same items in the same
/// order.
template <class Item>
class Prefetcher {
 public:
  /// At most `ahead` items wait while one more is made. With 0 there is no thread: `produce` is
  /// called by next(). Everything that `produce` refers to must outlive the prefetcher.
  Prefetcher(std::function<std::optional<Item>()> produce, std::size_t ahead)
      : produce_(std::move(produce)), channel_(ahead > 0 ? ahead : 1) {
    if (ahead > 0) producer_ = std::jthread([this] { run(); });
  }
  ~Prefetcher() { channel_.cancel(); }
  Prefetcher(const Prefetcher&) = delete;
  Prefetcher& operator=(const Prefetcher&) = delete;

  /// The next item, or nothing at the end. An exception of `produce` is thrown again once the items
  /// made before it are taken.
  [[nodiscard]] std::optional<Item> next() {
    return producer_.joinable() ? channel_.pop() : produce_();
  }

 private:
  void run() {
    try {
      while (std::optional<Item> item = produce_()) {
        if (!channel_.push(std::move(*item))) return;
      }
      channel_.close();
    } catch (...) {  // thrown again by the consumer's pop()
      channel_.fail(std::current_exception());
    }
  }

  std::function<std::optional<Item>()> produce_;
  Channel<Item> channel_;
  std::jthread producer_;  // last member: it uses the others until it is joined
};

}  // namespace stillmap
