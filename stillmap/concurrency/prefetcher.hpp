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

/// What a function gives, call by call, until it gives nothing; called ahead on a thread of its own
/// or only when asked. Either way the items are the same and come in the same order.
template <class Item>
class Prefetcher {
 public:
  /// At most `ahead` items wait, and one more is being made; with 0 there is no thread. What
  /// `produce` refers to outlives this.
  Prefetcher(std::function<std::optional<Item>()> produce, std::size_t ahead)
      : produce_(std::move(produce)), channel_(ahead > 0 ? ahead : 1) {
    if (ahead > 0) producer_ = std::jthread([this] { run(); });
  }
  ~Prefetcher() { channel_.cancel(); }
  Prefetcher(const Prefetcher&) = delete;
  Prefetcher& operator=(const Prefetcher&) = delete;

  /// The next item; nothing at the end. Throws what `produce` threw, after the items before.
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
    } catch (...) {  // the consumer's pop() throws it
      channel_.fail(std::current_exception());
    }
  }

  std::function<std::optional<Item>()> produce_;
  Channel<Item> channel_;
  std::jthread producer_;  // last: it runs while the rest lives
};

}  // namespace stillmap
