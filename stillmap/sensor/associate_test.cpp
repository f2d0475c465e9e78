// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/associate.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

// The rule to the letter: all pairs, sorted, taken while both stamps are free.
Pairs brute_force(const std::vector<double>& a, const std::vector<double>& b, double limit) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> all;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (std::abs(a[i] - b[j]) < limit) all.emplace_back(std::abs(a[i] - b[j]), i, j);
    }
  }
  std::ranges::sort(all);
  std::set<std::size_t> used_a, used_b;
  Pairs pairs;
  for (const auto& [difference, i, j] : all) {
    if (used_a.contains(i) || used_b.contains(j)) continue;
    used_a.insert(i);
    used_b.insert(j);
    pairs.emplace_back(i, j);
  }
  std::ranges::sort(pairs);
  return pairs;
}

std::vector<double> random_stamps(std::mt19937& rng, std::size_t count, std::uint32_t range) {
  std::set<double> stamps;  // multiples of 1/1024: differences are exact, ties are frequent
  while (stamps.size() < count) stamps.insert(rng() % range / 1024.0);
  return {stamps.begin(), stamps.end()};
}

TEST(Associate, TakesTheClosestPairFirst) {
  // 1.010 is nearest to 1.008, which leaves 1.000 to the farther 0.985.
  const std::vector<double> a = {1.000, 1.010};
  const std::vector<double> b = {0.985, 1.008};
  EXPECT_EQ(associate(a, b, 0.02), (Pairs{{0, 0}, {1, 1}}));
}

TEST(Associate, UsesEachStampOnce) {
  const std::vector<double> a = {1.000, 1.004};
  const std::vector<double> b = {1.003};
  EXPECT_EQ(associate(a, b, 0.02), (Pairs{{1, 0}}));
}

TEST(Associate, LeavesOutWhatIsFartherThanTheLimitOrAtIt) {
  const std::vector<double> a = {0.0, 10.0, 20.0};
  const std::vector<double> b = {0.25, 10.125, 19.0};
  EXPECT_EQ(associate(a, b, 0.25), (Pairs{{1, 1}}));
}

TEST(Associate, GivesATieToTheEarlierStamp) {
  const std::vector<double> a = {1.0, 2.0};
  const std::vector<double> b = {1.5};
  EXPECT_EQ(associate(a, b, 1.0), (Pairs{{0, 0}}));
  EXPECT_EQ(associate(b, a, 1.0), (Pairs{{0, 0}}));
}

TEST(Associate, OfNothingIsNothing) {
  const std::vector<double> some = {1.0, 2.0};
  EXPECT_TRUE(associate({}, some, 1.0).empty());
  EXPECT_TRUE(associate(some, {}, 1.0).empty());
}

TEST(Associate, EqualsBruteForce) {
  std::mt19937 rng(5);
  for (int round = 0; round < 200; ++round) {
    const std::vector<double> a = random_stamps(rng, rng() % 40, 200);
    const std::vector<double> b = random_stamps(rng, rng() % 40, 200);
    const double limit = (rng() % 30) / 1024.0;
    ASSERT_EQ(associate(a, b, limit), brute_force(a, b, limit)) << "round " << round;
  }
}

TEST(Associate, CopesWithManyStampsWithinTheLimit) {
  std::vector<double> a(200000), b(200000);
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = static_cast<double>(i) * 1e-8;
    b[i] = a[i] + 1e-9;
  }
  const Pairs pairs = associate(a, b, 0.02);  // 4e10 pairs are within the limit
  ASSERT_EQ(pairs.size(), a.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) ASSERT_EQ(pairs[i], std::make_pair(i, i));
}

TEST(Associate, WantsIncreasingStamps) {
  const std::vector<double> good = {1.0};
  const std::vector<double> twice = {1.0, 1.0};
  EXPECT_THROW((void)associate(good, twice, 1.0), InternalError);
}

}  // namespace
}  // namespace stillmap
