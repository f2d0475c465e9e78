// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <utility>

#include "stillmap/concurrency/channel.hpp"
#include "stillmap/concurrency/worker.hpp"

namespace stillmap {

/// Jobs and the frames at which their results are due.
///
/// With a worker a job runs meanwhile on its thread, without one at its submission; either way its
/// result is taken at the frame that was fixed beforehand, so that both give the same run. A slow
/// job makes collect_due() wait, never differ. What a job throws is thrown by the call that
/// collects it.
template <class Result>
class JobLedger {
 public:
  /// `worker` may be null: jobs then run inline. It must outlive the ledger. Each job begins with
  /// `before_job`, if there is one.
  explicit JobLedger(Worker* worker, std::function<void()> before_job = {})
      : worker_(worker), before_job_(std::move(before_job)) {}

  /// Frames are counted over those processed; due frames never decrease from job to job.
  void submit(std::int64_t due_frame, std::function<Result()> job) {
    auto task = std::make_shared<std::packaged_task<Result()>>(
        [before = before_job_, job = std::move(job)] {
          if (before) before();
          return job();
        });
    jobs_.push_back({due_frame, task->get_future()});
    if (worker_ != nullptr) {
      worker_->post([task] { (*task)(); });
    } else {
      (*task)();
    }
  }

  /// Results due at `frame` or before, in the order of submission.
  [[nodiscard]] std::vector<Result> collect_due(std::int64_t frame) {
    std::vector<Result> results;
    while (!jobs_.empty() && jobs_.front().due_frame <= frame) {
      std::future<Result> result = std::move(jobs_.front().result);
      jobs_.pop_front();  // first, for get() may throw
      results.push_back(result.get());
    }
    return results;
  }

  [[nodiscard]] bool empty() const { return jobs_.empty(); }

 private:
  struct Job {
    std::int64_t due_frame;
    std::future<Result> result;
  };

  Worker* worker_;
  std::function<void()> before_job_;
  std::deque<Job> jobs_;
};

}  // namespace stillmap
