// SPDX-License-Identifier: Apache-2.0
#include "stillmap/concurrency/newest.hpp"

#include <memory>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

TEST(Newest, KeepsTheLastValueAndCountsTheOthers) {
  Newest<std::unique_ptr<int>> newest;
  for (int i = 1; i <= 3; ++i) ASSERT_TRUE(newest.put(std::make_unique<int>(i)));
  const auto third = newest.take();
  ASSERT_TRUE(third);
  EXPECT_EQ(*third->value, 3);
  EXPECT_EQ(third->replaced, 2U);
  ASSERT_TRUE(newest.put(std::make_unique<int>(4)));
  EXPECT_EQ(newest.take()->replaced, 0U);
}

TEST(Newest, GivesTheLastValueBeforeTheEnd) {
  Newest<int> newest;
  ASSERT_TRUE(newest.put(1));
  newest.end();
  EXPECT_EQ(newest.take()->value, 1);
  EXPECT_FALSE(newest.take());
}

TEST(Newest, PassesAnExceptionOnAfterTheLastValue) {
  Newest<int> newest;
  ASSERT_TRUE(newest.put(1));
  newest.end(std::make_exception_ptr(std::runtime_error("broken")));
  EXPECT_EQ(newest.take()->value, 1);
  EXPECT_THROW((void)newest.take(), std::runtime_error);
}

TEST(Newest, TellsTheProducerThatNobodyTakes) {
  Newest<int> newest;
  newest.cancel();
  EXPECT_FALSE(newest.put(1));
}

TEST(Newest, LosesNothingBetweenThreads) {
  Newest<int> newest;
  constexpr int kValues = 10'000;
  std::jthread producer([&] {
    for (int i = 0; i < kValues; ++i) (void)newest.put(i);
    newest.end();
  });
  std::size_t seen = 0;
  int last = -1;
  while (const auto taken = newest.take()) {
    EXPECT_GT(taken->value, last);
    last = taken->value;
    seen += 1 + taken->replaced;
  }
  EXPECT_EQ(last, kValues - 1);
  EXPECT_EQ(seen, std::size_t{kValues});
}

}  // namespace
}  // namespace stillmap
