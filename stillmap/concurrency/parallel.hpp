// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <exception>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "stillmap/concurrency/channel.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {

/// Calls consume(i, produce(i)) for i from 0 to count - 1: `consume` on the calling thread and in
/// order, `produce` on `threads` other threads, each at most three results ahead. The results of
/// `produce` must not depend on the order of its calls. An exception of either is thrown again
/// after all threads have ended.
template <class Produce, class Consume>
void produce_in_parallel(std::size_t count,
                         std::size_t threads,
                         const Produce& produce,
                         const Consume& consume) {
  STILLMAP_CHECK(threads > 0);
  using Item = std::invoke_result_t<const Produce&, std::size_t>;
  std::deque<Channel<Item>> channels;  // one per thread; outlives the threads
  for (std::size_t k = 0; k < threads; ++k) channels.emplace_back(2);
  std::vector<std::jthread> workers;
  for (std::size_t k = 0; k < threads; ++k) {
    workers.emplace_back([&, k] {
      try {
        for (std::size_t i = k; i < count; i += threads) {
          if (!channels[k].push(produce(i))) return;
        }
        channels[k].close();
      } catch (...) {
        channels[k].fail(std::current_exception());
      }
    });
  }
  try {
    for (std::size_t i = 0; i < count; ++i) consume(i, *channels[i % threads].pop());
  } catch (...) {
    for (Channel<Item>& channel : channels) channel.cancel();
    throw;
  }
}

/// Calls work(i) for i from 0 to count - 1: work(0) on the calling thread, each other on a thread
/// of its own. After all have ended, throws the exception of the least i whose call threw, if any.
template <class Work>
void in_parallel(std::size_t count, const Work& work) {
  std::vector<std::exception_ptr> failures(count);
  const auto attempt = [&](std::size_t i) {
    try {
      work(i);
    } catch (...) {
      failures[i] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < count; ++i) others.emplace_back(attempt, i);
    if (count > 0) attempt(0);
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace stillmap
