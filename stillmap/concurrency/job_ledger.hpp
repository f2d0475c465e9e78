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
/// With a worker, a job runs on the worker's thread; without one it runs inside submit(). Either
/// way its result is collected at the frame that was fixed at its submission, so that both give the
/// same run. A slow job makes collect_due() wait but does not change its results. An exception that
/// a job throws is thrown again by the collect_due() that collects the job.
template <class Result>
class JobLedger {
 public:
  /// Without a `worker` (null) jobs run inline. The worker must outlive the ledger. `before_job`,
  /// unless empty, is called at the beginning of each job.
  explicit JobLedger(Worker* worker, std::function<void()> before_job = {})
      : worker_(worker), before_job_(std::move(before_job)) {}

  /// `due_frame` counts processed frames and must not be less than that of the job before.
  void submit(std::int64_t due_frame, std::function<Result()> job) {
    auto task = std::make_shared<std::packaged_task<Result()>>(
        [before = before_job_, job = std::move(job)] {
          if (before) before();
          return job();
        });
    jobs_.push_back({due_frame, task->get_future().share()});
    if (worker_ != nullptr) {
      worker_->post([task] { (*task)(); });
    } else {
      (*task)();
    }
  }

  /// A ledger of the same pending jobs, whose own jobs run inline. Pending jobs refer to what they
  /// refer to, which must outlive the copy's use of them.
  [[nodiscard]] JobLedger inline_copy() const {
    JobLedger copy(nullptr, before_job_);
    copy.jobs_ = jobs_;
    return copy;
  }

  /// Results due at `frame` or before, in the order of submission.
  [[nodiscard]] std::vector<Result> collect_due(std::int64_t frame) {
    std::vector<Result> results;
    while (!jobs_.empty() && jobs_.front().due_frame <= frame) {
      const std::shared_future<Result> result = std::move(jobs_.front().result);
      jobs_.pop_front();  // first, for get() may throw
      results.push_back(result.get());
    }
    return results;
  }

  [[nodiscard]] bool empty() const { return jobs_.empty(); }

 private:
  struct Job {
    std::int64_t due_frame;
    std::shared_future<Result> result;  // an inline copy of the ledger reads it too
  };

  Worker* worker_;
  std::function<void()> before_job_;
  std::deque<Job> jobs_;
};

}  // namespace stillmap
