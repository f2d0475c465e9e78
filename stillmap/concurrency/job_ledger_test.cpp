// SPDX-License-Identifier: Apache-2.0
#include "stillmap/concurrency/job_ledger.hpp"

#include <atomic>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

// What a run of 40 frames collects, frame by frame: every third frame submits a job that is due
// two to four frames later.
std::vector<std::vector<int>> collected(Worker* worker) {
  JobLedger<int> ledger(worker);
  std::vector<std::vector<int>> results;
  for (std::int64_t frame = 0; frame < 40; ++frame) {
    results.push_back(ledger.collect_due(frame));
    if (frame % 3 != 0) continue;
    const std::int64_t due = frame + 2 + frame / 20;
    ledger.submit(due, [frame] { return static_cast<int>(100 + frame); });
    ledger.submit(due, [frame] { return static_cast<int>(200 + frame); });
  }
  return results;
}

TEST(JobLedger, GivesResultsAtTheirFramesInTheOrderOfSubmission) {
  const std::vector<std::vector<int>> results = collected(nullptr);
  EXPECT_EQ(results[1], std::vector<int>{});
  EXPECT_EQ(results[2], (std::vector{100, 200}));
  EXPECT_EQ(results[3], std::vector<int>{});
  EXPECT_EQ(results[5], (std::vector{103, 203}));
  EXPECT_EQ(results[23], std::vector<int>{});  // from frame 20 on one frame later
  EXPECT_EQ(results[24], (std::vector{121, 221}));
}

TEST(JobLedger, GivesTheSameWithAWorker) {
  Worker worker;
  EXPECT_EQ(collected(&worker), collected(nullptr));
}

TEST(JobLedger, WaitsForAJobThatIsDue) {
  Worker worker;
  JobLedger<int> ledger(&worker);
  std::promise<int> value;
  std::shared_future<int> known = value.get_future().share();
  ledger.submit(5, [known] { return known.get(); });
  EXPECT_TRUE(ledger.collect_due(4).empty());
  EXPECT_FALSE(ledger.empty());
  const std::jthread sets_it([&] { value.set_value(9); });
  EXPECT_EQ(ledger.collect_due(5), std::vector{9});
  EXPECT_TRUE(ledger.empty());
}

TEST(JobLedger, ThrowsWhatAJobThrewWhereItIsCollectedAndGoesOn) {
  Worker with_thread;
  for (Worker* worker : {static_cast<Worker*>(nullptr), &with_thread}) {
    JobLedger<int> ledger(worker);
    ledger.submit(1, []() -> int { throw std::runtime_error("job failed"); });
    ledger.submit(2, [] { return 7; });
    EXPECT_TRUE(ledger.collect_due(0).empty());
    try {
      (void)ledger.collect_due(1);
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "job failed");
    }
    EXPECT_EQ(ledger.collect_due(2), std::vector{7});
  }
}

TEST(Worker, RunsTasksInOrderOnOneOtherThread) {
  std::vector<int> order;
  std::vector<std::thread::id> threads;
  std::promise<void> done;
  Worker worker;
  for (int i = 0; i < 50; ++i) {
    worker.post([&, i] {
      order.push_back(i);
      threads.push_back(std::this_thread::get_id());
      if (i == 49) done.set_value();
    });
  }
  done.get_future().wait();
  for (int i = 0; i < 50; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
  for (const std::thread::id id : threads) EXPECT_EQ(id, threads[0]);
  EXPECT_NE(threads[0], std::this_thread::get_id());
}

TEST(Worker, EndsWithTheRunningTaskAndDropsThoseNotBegun) {
  std::promise<void> begun, release;
  std::atomic<bool> first_ended = false;
  std::atomic<int> others = 0;
  std::optional<Worker> worker(std::in_place);
  worker->post([&] {
    begun.set_value();
    release.get_future().wait();
    first_ended = true;
  });
  begun.get_future().wait();
  for (int i = 0; i < 8; ++i) worker->post([&] { ++others; });
  // The queue is full: this waits until the worker is being destroyed, then lets the first end.
  std::jthread ninth([&, to = &*worker] {
    to->post([&] { ++others; });
    release.set_value();
  });
  worker.reset();
  EXPECT_TRUE(first_ended);
  EXPECT_EQ(others, 0);
}

}  // namespace
}  // namespace stillmap
