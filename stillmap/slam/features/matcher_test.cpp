// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/matcher.hpp"

#include <algorithm>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/feature_images.hpp"

namespace stillmap {

// Here and not in the header: only tests compare and print matches.
static bool operator==(const FeatureMatch& a, const FeatureMatch& b) {
  return std::tie(a.query, a.feature, a.distance) == std::tie(b.query, b.feature, b.distance);
}
static void PrintTo(const FeatureMatch& m, std::ostream* out) {  // NOLINT: gtest's name
  *out << m.query << "->" << m.feature << " (" << m.distance << ")";
}

namespace {

using Matches = std::vector<FeatureMatch>;

TEST(HammingDistance, CountsDifferingBits) {
  TestDice dice(1);
  for (int i = 0; i < 200; ++i) {
    const Descriptor a = dice.descriptor(), b = dice.descriptor();
    int expected = 0;
    for (std::size_t bit = 0; bit < 256; ++bit) {
      expected += ((a[bit / 64] >> (bit % 64)) & 1U) != ((b[bit / 64] >> (bit % 64)) & 1U) ? 1 : 0;
    }
    EXPECT_EQ(hamming_distance(a, b), expected);
  }
  EXPECT_EQ(hamming_distance({0, 0, 0, 0}, {~0ULL, ~0ULL, ~0ULL, ~0ULL}), 256);
}

// Few different descriptors, so that near ones, equal ones and ties are common.
Features random_features(int count, TestDice& dice, const std::vector<Descriptor>& kinds) {
  Features f;
  for (int i = 0; i < count; ++i) {
    f.px.push_back(dice.point(-10, 330, 250));
    f.level.push_back(static_cast<std::uint8_t>(dice.integer(0, 3)));
    f.depth_m.push_back(dice.integer(0, 3) == 0 ? 0.0F : dice.uniform(0.5F, 5.0F));
    f.angle_deg.push_back(dice.uniform(0, 360));
    f.descriptors.push_back(dice.flipped(kinds[dice.bits() % kinds.size()], dice.integer(0, 60)));
  }
  f.raw_px = f.ideal_px = f.px;
  f.sensor_depth_m = f.depth_m;
  f.grid = FeatureGrid(f.px, 320, 240);
  return f;
}

std::vector<Descriptor> random_kinds(int count, TestDice& dice) {
  std::vector<Descriptor> kinds;
  for (int i = 0; i < count; ++i) kinds.push_back(dice.descriptor());
  return kinds;
}

bool is_candidate(const Projection& p, const Features& f, std::uint32_t i) {
  if (f.level[i] < p.min_level || f.level[i] > p.max_level) return false;
  if (std::hypot(f.px[i].x() - p.px.x(), f.px[i].y() - p.px.y()) > p.radius_px) return false;
  if (f.depth_m[i] == 0) return true;
  return std::abs(1 / f.depth_m[i] - p.inverse_depth) <= p.max_inverse_depth_error;
}

// The documented choice, by sorting all candidates: nearest first, then in the grid's order.
std::optional<FeatureMatch> best_plainly(std::uint32_t query,
                                         const Projection& p,
                                         const Features& f,
                                         std::span<const std::uint8_t> taken,
                                         const MatchRules& rules) {
  std::vector<std::tuple<int, int, int, std::uint32_t>> ranked;
  for (std::uint32_t i = 0; i < f.size(); ++i) {
    if ((!taken.empty() && taken[i] != 0) || !is_candidate(p, f, i)) continue;
    const auto cell = [](float x, int cells) {
      return std::clamp(static_cast<int>(std::floor(x / 16)), 0, cells - 1);
    };
    ranked.emplace_back(hamming_distance(*p.descriptor, f.descriptors[i]),
                        cell(f.px[i].y(), 15),
                        cell(f.px[i].x(), 20),
                        i);
  }
  std::ranges::sort(ranked);
  if (ranked.empty() || std::get<0>(ranked[0]) > rules.max_distance) return std::nullopt;
  if (ranked.size() > 1 && f.level[std::get<3>(ranked[0])] == f.level[std::get<3>(ranked[1])] &&
      std::get<0>(ranked[0]) > rules.max_ratio * std::get<0>(ranked[1])) {
    return std::nullopt;
  }
  return FeatureMatch{query, std::get<3>(ranked[0]), std::get<0>(ranked[0])};
}

Matches one_to_one_plainly(const Matches& wanted) {
  Matches kept;
  for (const FeatureMatch& m : wanted) {
    const bool beaten = std::ranges::any_of(wanted, [&](const FeatureMatch& other) {
      return other.feature == m.feature &&
             std::tie(other.distance, other.query) < std::tie(m.distance, m.query);
    });
    if (!beaten) kept.push_back(m);
  }
  return kept;
}

std::vector<Projection> random_projections(int count,
                                           TestDice& dice,
                                           const std::vector<Descriptor>& kinds) {
  std::vector<Projection> projections;
  for (int i = 0; i < count; ++i) {
    Projection p;
    p.px = dice.point(-30, 350, 270);
    p.radius_px = dice.uniform(5, 50);
    p.inverse_depth = 1 / dice.uniform(0.5F, 5.0F);
    p.max_inverse_depth_error = dice.uniform(0, 1);
    p.min_level = dice.integer(0, 2);
    p.max_level = p.min_level + dice.integer(0, 2);
    p.descriptor = &kinds[dice.bits() % kinds.size()];
    projections.push_back(p);
  }
  return projections;
}

class MatchProjections : public testing::TestWithParam<MatchRules> {};

TEST_P(MatchProjections, EqualsBruteForce) {
  std::size_t matched = 0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    TestDice dice(seed);
    const std::vector<Descriptor> kinds = random_kinds(12, dice);
    const Features features = random_features(400, dice, kinds);
    const std::vector<Projection> projections = random_projections(150, dice, kinds);
    std::vector<std::uint8_t> taken;
    for (std::size_t i = 0; seed % 2 == 0 && i < features.size(); ++i) {
      taken.push_back(dice.integer(0, 3) == 0 ? 1 : 0);
    }
    Matches wanted;
    for (std::uint32_t q = 0; q < projections.size(); ++q) {
      const auto best = best_plainly(q, projections[q], features, taken, GetParam());
      if (best) wanted.push_back(*best);
    }
    const Matches found = match_projections(projections, features, taken, GetParam());
    ASSERT_EQ(found, one_to_one_plainly(wanted)) << seed;
    matched += found.size();
  }
  EXPECT_GT(matched, 200U);
}

INSTANTIATE_TEST_SUITE_P(Rules,
                         MatchProjections,
                         testing::Values(MatchRules{},
                                         MatchRules{.max_distance = 30, .max_ratio = 1.0},
                                         MatchRules{.max_distance = 100, .max_ratio = 0.7},
                                         MatchRules{.max_distance = 256, .max_ratio = 0.9}));

// One feature at (100, 100), level 1, 2 m away, and a projection right on it.
struct OnePair {
  Descriptor descriptor{1, 2, 3, 4};
  Features features;
  Projection projection;

  OnePair() {
    features.px = {{100, 100}};
    features.level = {1};
    features.depth_m = {2.0F};
    features.descriptors = {descriptor};
    features.grid = FeatureGrid(features.px, 320, 240);
    projection = {{100, 100}, 5, 0.5F, 0.1F, 1, 1, &descriptor};
  }
  [[nodiscard]] std::size_t matches(std::vector<std::uint8_t> taken = {}) const {
    return match_projections({&projection, 1}, features, taken, {}).size();
  }
};

TEST(MatchProjections, EachGateAlone) {
  EXPECT_EQ(OnePair().matches(), 1U);
  EXPECT_EQ(OnePair().matches({0}), 1U);
  EXPECT_EQ(OnePair().matches({1}), 0U);
  OnePair far;
  far.projection.px = {103, 104};  // exactly 5 px away
  EXPECT_EQ(far.matches(), 1U);
  far.projection.px = {103, 104.1F};
  EXPECT_EQ(far.matches(), 0U);
  OnePair coarse;
  coarse.projection.min_level = coarse.projection.max_level = 2;
  EXPECT_EQ(coarse.matches(), 0U);
  coarse.projection.min_level = coarse.projection.max_level = 0;
  EXPECT_EQ(coarse.matches(), 0U);
  OnePair behind;
  behind.projection.inverse_depth = 0.35F;
  EXPECT_EQ(behind.matches(), 0U);
  behind.features.depth_m = {0};  // unknown depth passes
  EXPECT_EQ(behind.matches(), 1U);
  OnePair unlike;
  unlike.features.descriptors[0] = {~1ULL, ~2ULL, 3, 4};
  EXPECT_EQ(unlike.matches(), 0U);
}

TEST(MatchProjections, NothingToMatchGivesNothing) {
  const OnePair pair;
  EXPECT_TRUE(match_projections({}, pair.features, {}, {}).empty());
  EXPECT_TRUE(match_projections({&pair.projection, 1}, Features{}, {}, {}).empty());
}

// Both ways the nearest: a's feature is nearest to b's among all of b, and b's to a's among the
// chosen of a.
TEST(MatchAll, AreMutualBestMatches) {
  std::size_t matched = 0;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    TestDice dice(seed);
    const std::vector<Descriptor> kinds = random_kinds(60, dice);
    const Features a = random_features(120, dice, kinds), b = random_features(100, dice, kinds);
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t i = 0; i < a.size(); ++i) {
      if (dice.integer(0, 3) != 0) chosen.push_back(i);
    }
    const MatchRules rules{.max_distance = 60, .max_ratio = 0.9};
    Matches expected;
    for (const std::uint32_t i : chosen) {
      std::vector<std::pair<int, std::uint32_t>> forward, backward;
      for (std::uint32_t j = 0; j < b.size(); ++j) {
        forward.emplace_back(hamming_distance(a.descriptors[i], b.descriptors[j]), j);
      }
      std::ranges::sort(forward);
      const auto [distance, best] = forward[0];
      for (const std::uint32_t k : chosen) {
        backward.emplace_back(hamming_distance(a.descriptors[k], b.descriptors[best]), k);
      }
      if (std::ranges::min(backward).second != i || distance > 60) continue;
      if (distance <= 0.9 * forward[1].first) expected.push_back({i, best, distance});
    }
    ASSERT_EQ(match_all(a, chosen, b, rules), expected) << seed;
    matched += expected.size();
  }
  EXPECT_GT(matched, 100U);
}

TEST(MatchAll, NothingToMatchGivesNothing) {
  const OnePair pair;
  const std::vector<std::uint32_t> first = {0};
  EXPECT_TRUE(match_all(pair.features, {}, pair.features, {}).empty());
  EXPECT_TRUE(match_all(pair.features, first, Features{}, {}).empty());
  EXPECT_EQ(match_all(pair.features, first, pair.features, {.max_distance = 0, .max_ratio = 0.5}),
            (Matches{{0, 0, 0}}));
}

TEST(KeepConsistentRotations, KeepsTheThreeCommonTurnsOnly) {
  // Query i and feature i; 40 turn by 50 degrees, 30 by 62, 20 by 74, 5 by 200, 1 by 300.
  Matches matches;
  std::vector<float> query_deg, feature_deg;
  const auto add = [&](int count, float turn) {
    for (int i = 0; i < count; ++i) {
      const auto index = static_cast<std::uint32_t>(matches.size());
      const float angle = static_cast<float>(index * 37 % 360);
      matches.push_back({index, index, 0});
      query_deg.push_back(std::fmod(angle + turn, 360.0F));
      feature_deg.push_back(angle);
    }
  };
  add(40, 49), add(5, 200), add(30, 61), add(1, 300), add(20, 73);
  Matches expected;
  for (const FeatureMatch& m : matches) {
    if (m.query < 40 || (m.query >= 45 && m.query < 75) || m.query >= 76) expected.push_back(m);
  }
  EXPECT_EQ(keep_consistent_rotations(matches, query_deg, feature_deg), expected);
}

TEST(KeepConsistentRotations, RareTurnsAreDroppedEvenAmongTheThree) {
  Matches matches;
  std::vector<float> query_deg(40, 10.0F), feature_deg(40, 0.0F);
  for (std::uint32_t i = 0; i < 40; ++i) matches.push_back({i, i, 0});
  query_deg[7] = 100;                                   // 1 of 36: below a tenth
  query_deg[20] = query_deg[21] = query_deg[22] = 200;  // 3 of 36: just not a tenth
  EXPECT_EQ(keep_consistent_rotations(matches, query_deg, feature_deg).size(), 36U);
  query_deg[23] = 200;  // 4 of 35
  EXPECT_EQ(keep_consistent_rotations(matches, query_deg, feature_deg).size(), 39U);
}

TEST(KeepConsistentRotations, TurnsWrapRoundTheCircle) {
  // Turns of 358, -2 and 2 degrees are all about none.
  const Matches matches = {{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {3, 3, 0}};
  const std::vector<float> query_deg = {359, 0, 3, 181}, feature_deg = {1, 2, 1, 1};
  EXPECT_EQ(keep_consistent_rotations(matches, query_deg, feature_deg).size(), 4U);
  Matches many;
  std::vector<float> query(60), feature(60);
  for (std::uint32_t i = 0; i < 60; ++i) {
    many.push_back({i, i, 0});
    feature[i] = static_cast<float>(6 * i);
    const float turn = i == 0 ? 180.0F : (i % 2 == 0 ? -5.0F : 5.0F);
    query[i] = std::fmod(feature[i] + turn + 360.0F, 360.0F);
  }
  EXPECT_EQ(keep_consistent_rotations(many, query, feature).size(), 59U);
  EXPECT_TRUE(keep_consistent_rotations({}, query, feature).empty());
}

}  // namespace
}  // namespace stillmap
