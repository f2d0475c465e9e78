// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <thread>

#include <sys/resource.h>
#include <unistd.h>

#include "stillmap/concurrency/channel.hpp"

namespace stillmap {

/// One thread that runs tasks in the order in which they are posted. The destructor drops the tasks
/// that have not begun and waits for the one that runs. Tasks must not throw; those of JobLedger
/// put their exceptions into a future.
class Worker {
 public:
  enum class Priority {
    kNormal,
    kLow,  ///< the other threads of this process get a processor first
  };
  explicit Worker(Priority priority = Priority::kNormal)
      : thread_([this, priority] {
          if (priority == Priority::kLow) give_way();
          run();
        }) {}
  ~Worker() {
    tasks_.cancel();
    tasks_.close();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Waits while kMaxPending tasks are pending.
  void post(std::function<void()> task) { (void)tasks_.push(std::move(task)); }

 private:
  // Affects speed only. If the system refuses, the thread keeps its normal priority.
  static void give_way() {
    constexpr int kNiceness = 10;
    (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);
  }

  void run() {
    while (std::optional<std::function<void()>> task = tasks_.pop()) (*task)();
  }

  static constexpr std::size_t kMaxPending = 8;
  Channel<std::function<void()>> tasks_{kMaxPending};
  std::jthread thread_;  // last member: it uses the channel until it is joined
};

}  // namespace stillmap
