// SPDX-License-Identifier: Apache-2.0
#include "stillmap/concurrency/prefetcher.hpp"

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

std::vector<int> all_of(Prefetcher<int>& ahead) {
  std::vector<int> items;
  while (const std::optional<int> item = ahead.next()) items.push_back(*item);
  return items;
}

TEST(Prefetcher, GivesTheSameItemsWithAndWithoutAThread) {
  for (const std::size_t ahead : {0U, 1U, 4U}) {
    int next = 0;
    Prefetcher<int> numbers(
        [&]() -> std::optional<int> {
          if (next == 50) return std::nullopt;
          return next++;
        },
        ahead);
    const std::vector<int> items = all_of(numbers);
    ASSERT_EQ(items.size(), 50U);
    for (int i = 0; i < 50; ++i) EXPECT_EQ(items[static_cast<std::size_t>(i)], i);
  }
}

TEST(Prefetcher, AsksOnlyWhenAskedWithoutAThread) {
  int next = 0;
  Prefetcher<int> numbers([&]() -> std::optional<int> { return next++; }, 0);
  EXPECT_EQ(next, 0);
  EXPECT_EQ(numbers.next(), 0);
  EXPECT_EQ(next, 1);
}

TEST(Prefetcher, DoesNotRunFarAhead) {
  std::atomic<int> made = 0;
  Prefetcher<int> numbers([&]() -> std::optional<int> { return made < 100 ? ++made : 0; }, 3);
  for (int i = 1; i <= 60; ++i) {
    EXPECT_EQ(numbers.next(), i);
    EXPECT_LE(made, i + 3 + 1 + 1);  // waiting, being pushed, and the room just made
  }
}

TEST(Prefetcher, PassesOnWhatIsThrownAfterTheItemsBefore) {
  for (const std::size_t ahead : {0U, 2U}) {
    int next = 0;
    Prefetcher<int> numbers(
        [&]() -> std::optional<int> {
          if (next == 5) throw std::runtime_error("five");
          return next++;
        },
        ahead);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(numbers.next(), i);
    EXPECT_THROW((void)numbers.next(), std::runtime_error);
  }
}

TEST(Prefetcher, EndsWhileMuchIsLeft) {
  Prefetcher<std::string> endless([] { return std::optional<std::string>("again"); }, 2);
  EXPECT_EQ(endless.next(), "again");
}

}  // namespace
}  // namespace stillmap
