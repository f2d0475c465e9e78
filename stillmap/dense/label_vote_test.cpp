// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/label_vote.hpp"

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

std::uint8_t winner(const std::vector<int>& votes) {
  LabelVote vote;
  for (const int label : votes) vote.add(static_cast<std::uint8_t>(label), 1);
  return vote.winner();
}

TEST(LabelVote, TheMostVotesWin) {
  EXPECT_EQ(winner({7}), 7);
  EXPECT_EQ(winner({0, 0, 5}), 0);
  EXPECT_EQ(winner({5, 0, 5, 0, 5}), 5);
  EXPECT_EQ(winner({1, 2, 3, 4, 3}), 3);
}

TEST(LabelVote, OfEqualsTheSmallerWins) {
  EXPECT_EQ(winner({9, 4}), 4);
  EXPECT_EQ(winner({4, 9}), 4);
  EXPECT_EQ(winner({200, 30, 20, 200, 20, 30}), 20);
}

TEST(LabelVote, WithoutVotesItIsZero) {
  EXPECT_EQ(winner({}), 0);
  EXPECT_EQ(winner({1, 2, 3, 4, 5}), 0) << "all five cancel out";
}

TEST(LabelVote, WeightsCountAsThatManyVotes) {
  LabelVote vote;
  vote.add(3, 10);
  vote.add(2, 4);
  vote.add(2, 5);
  EXPECT_EQ(vote.winner(), 3);
  vote.add(2, 1);
  EXPECT_EQ(vote.winner(), 2);
  vote.add(1, 65000);
  EXPECT_EQ(vote.winner(), 1);
}

TEST(LabelVote, AHeavyFifthLabelTakesAPlace) {
  LabelVote vote;
  for (std::uint8_t label = 1; label <= 4; ++label) vote.add(label, label);
  vote.add(9, 11);  // more than all the others together
  EXPECT_EQ(vote.winner(), 9);
}

TEST(LabelVote, AMajorityWinsAmongManyLabelsInAnyOrder) {
  std::mt19937 rng(1);
  for (int round = 0; round < 2000; ++round) {
    const std::size_t others = rng() % 60;
    const int majority = static_cast<int>(rng() % 256);
    std::vector<int> votes(others + 1, majority);
    const unsigned labels = 1 + rng() % 256;
    for (std::size_t i = 0; i < others; ++i) votes.push_back(static_cast<int>(rng() % labels));
    std::shuffle(votes.begin(), votes.end(), rng);
    ASSERT_EQ(winner(votes), majority) << "round " << round;
  }
}

TEST(LabelVote, IsExactForFourLabelsInAnyOrder) {
  std::mt19937 rng(2);
  for (int round = 0; round < 2000; ++round) {
    std::array<int, 256> counts{};
    std::array<int, 4> labels{};
    for (int& label : labels) label = static_cast<int>(rng() % 256);
    std::vector<int> votes(1 + rng() % 40);
    for (int& label : votes) {
      label = labels[rng() % 4];
      ++counts[static_cast<std::size_t>(label)];
    }
    const auto* expected = std::max_element(counts.begin(), counts.end());
    ASSERT_EQ(winner(votes), expected - counts.begin()) << "round " << round;
  }
}

}  // namespace
}  // namespace stillmap
