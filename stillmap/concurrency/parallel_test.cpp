// SPDX-License-Identifier: Apache-2.0
#include "stillmap/concurrency/parallel.hpp"

#include <atomic>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

TEST(ProduceInParallel, GivesEveryResultInOrder) {
  for (const std::size_t threads : {1U, 2U, 3U, 8U}) {
    std::vector<std::size_t> squares;
    produce_in_parallel(
        100,
        threads,
        [](std::size_t i) { return i * i; },
        [&](std::size_t i, std::size_t square) {
          EXPECT_EQ(i, squares.size());
          squares.push_back(square);
        });
    ASSERT_EQ(squares.size(), 100U);
    for (std::size_t i = 0; i < squares.size(); ++i) EXPECT_EQ(squares[i], i * i);
  }
}

TEST(ProduceInParallel, DoesNotRunFarAhead) {
  std::atomic<std::size_t> produced = 0;
  produce_in_parallel(
      60,
      2,
      [&](std::size_t i) {
        ++produced;
        return i;
      },
      [&](std::size_t i, std::size_t) { EXPECT_LE(produced, i + 1 + 2 * 3); });
  EXPECT_EQ(produced, 60U);
}

TEST(ProduceInParallel, PassesOnWhatAThreadThrowsAfterTheResultsBefore) {
  std::size_t consumed = 0;
  const auto produce = [](std::size_t i) {
    if (i == 20) throw std::runtime_error("twenty");
    return i;
  };
  EXPECT_THROW(produce_in_parallel(1000, 3, produce, [&](std::size_t, std::size_t) { ++consumed; }),
               std::runtime_error);
  EXPECT_EQ(consumed, 20U);
}

TEST(ProduceInParallel, StopsTheThreadsWhenTheConsumerThrows) {
  const auto consume = [](std::size_t i, std::size_t) {
    if (i == 7) throw std::runtime_error("seven");
  };
  EXPECT_THROW(produce_in_parallel(
                   100000, 3, [](std::size_t i) { return i; }, consume),
               std::runtime_error);
}

TEST(ProduceInParallel, NeedsNothingToDo) {
  produce_in_parallel(
      0, 2, [](std::size_t i) { return i; }, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(InParallel, DoesEachOnceAndTheFirstHere) {
  for (const std::size_t count : {0U, 1U, 2U, 7U}) {
    std::vector<int> done(count, 0);
    std::vector<std::thread::id> threads(count);
    in_parallel(count, [&](std::size_t i) {
      ++done[i];
      threads[i] = std::this_thread::get_id();
    });
    EXPECT_EQ(done, std::vector<int>(count, 1));
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(threads[i] == std::this_thread::get_id(), i == 0) << i;
    }
  }
}

TEST(InParallel, PassesOnTheFirstFailureAfterAllHaveEnded) {
  std::atomic<int> ended = 0;
  const auto work = [&](std::size_t i) {
    ++ended;
    if (i == 1) throw std::runtime_error("one");
    if (i == 3) throw std::invalid_argument("three");
  };
  EXPECT_THROW(in_parallel(5, work), std::runtime_error);
  EXPECT_EQ(ended, 5);
}

}  // namespace
}  // namespace stillmap
