// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/loop/loop_gate.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

using Ids = std::vector<KeyframeId>;

// A candidate in a map where key frames share landmarks with the two before and after.
GateCandidate at(std::uint32_t k) {
  GateCandidate candidate{KeyframeId(k), {}};
  for (std::uint32_t n = k < 2 ? 0 : k - 2; n <= k + 2; ++n) {
    if (n != k) candidate.neighbours.push_back(KeyframeId(n));
  }
  return candidate;
}

Ids advance(LoopGate& gate, const std::vector<std::uint32_t>& found) {
  std::vector<GateCandidate> candidates;
  for (const std::uint32_t k : found) candidates.push_back(at(k));
  return gate.advance(candidates);
}

TEST(LoopGate, PassesWhatThreeInARowFind) {
  LoopGate gate({.consecutive = 3, .max_missed = 0});
  EXPECT_TRUE(advance(gate, {10}).empty());
  EXPECT_TRUE(advance(gate, {12}).empty());
  EXPECT_EQ(advance(gate, {15}), Ids{KeyframeId(15)});
  EXPECT_EQ(advance(gate, {16}), Ids{KeyframeId(16)});
}

TEST(LoopGate, OneOffIsNoLoop) {
  LoopGate gate({.consecutive = 2, .max_missed = 0});
  EXPECT_TRUE(advance(gate, {10}).empty());
  EXPECT_TRUE(advance(gate, {50}).empty());
  EXPECT_TRUE(advance(gate, {90}).empty());
  EXPECT_TRUE(advance(gate, {10}).empty());
  EXPECT_TRUE(advance(gate, {}).empty());
  EXPECT_TRUE(advance(gate, {10}).empty());
}

TEST(LoopGate, WaitsForAsManyAsMayMiss) {
  for (const int allowed : {0, 1, 2}) {
    for (const int missing : {0, 1, 2, 3}) {
      LoopGate gate({.consecutive = 2, .max_missed = allowed});
      EXPECT_TRUE(advance(gate, {10}).empty());
      for (int i = 0; i < missing; ++i) EXPECT_TRUE(advance(gate, {}).empty());
      EXPECT_EQ(!advance(gate, {11}).empty(), missing <= allowed) << allowed << " " << missing;
    }
  }
}

TEST(LoopGate, SeveralPlacesAreFollowedAtOnce) {
  LoopGate gate({.consecutive = 3, .max_missed = 0});
  EXPECT_TRUE(advance(gate, {10, 70}).empty());
  EXPECT_TRUE(advance(gate, {70, 10, 40}).empty());
  EXPECT_EQ(advance(gate, {40, 71, 11}), (Ids{KeyframeId(71), KeyframeId(11)}));
  EXPECT_EQ(advance(gate, {41, 11}), (Ids{KeyframeId(41), KeyframeId(11)}));
}

// Two candidates of one key frame are one finding, not two.
TEST(LoopGate, CandidatesOfOneKeyframeDoNotAddUp) {
  LoopGate gate({.consecutive = 3, .max_missed = 0});
  EXPECT_TRUE(advance(gate, {10, 11, 12, 13}).empty());
  EXPECT_TRUE(advance(gate, {10, 11, 12, 13}).empty());
  EXPECT_EQ(advance(gate, {10, 11, 12, 13}).size(), 4U);
}

TEST(LoopGate, OneInARowNeedsNoPast) {
  LoopGate gate({.consecutive = 1, .max_missed = 0});
  EXPECT_EQ(advance(gate, {10, 50}), (Ids{KeyframeId(10), KeyframeId(50)}));
}

TEST(LoopGate, ClearForgets) {
  LoopGate gate({.consecutive = 2, .max_missed = 1});
  EXPECT_TRUE(advance(gate, {10}).empty());
  gate.clear();
  EXPECT_TRUE(advance(gate, {10}).empty());
  EXPECT_FALSE(advance(gate, {10}).empty());
}

// The plain definition without gaps: a candidate passes if there is a chain of candidates, one of
// each of the last key frames, in which neighbours meet.
bool chain_ends_at(const std::vector<std::vector<std::uint32_t>>& history,
                   std::size_t step,
                   std::uint32_t k,
                   int length) {
  if (length == 1) return true;
  if (step == 0) return false;
  return std::ranges::any_of(history[step - 1], [&](std::uint32_t before) {
    const bool meet = before + 4 >= k && k + 4 >= before;  // both groups reach two to each side
    return meet && chain_ends_at(history, step - 1, before, length - 1);
  });
}

TEST(LoopGate, IsAsDefinedOnRandomCandidates) {
  std::mt19937 rng(1);
  int passed = 0;
  for (int trial = 0; trial < 50; ++trial) {
    LoopGate gate({.consecutive = 3, .max_missed = 0});
    std::vector<std::vector<std::uint32_t>> history;
    for (std::size_t step = 0; step < 30; ++step) {
      history.emplace_back();
      for (std::uint32_t n = rng() % 4U; n > 0; --n) history.back().push_back(2 + rng() % 30U);
      Ids expected;
      for (const std::uint32_t k : history.back()) {
        if (chain_ends_at(history, step, k, 3)) expected.push_back(KeyframeId(k));
      }
      EXPECT_EQ(advance(gate, history.back()), expected);
      passed += static_cast<int>(expected.size());
    }
  }
  EXPECT_GT(passed, 100);
}

}  // namespace
}  // namespace stillmap
