// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/map/place_index.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/feature_images.hpp"

namespace stillmap {
namespace {

using Place = std::vector<Descriptor>;

Place random_place(TestDice& dice, std::size_t size = 200) {
  Place place;
  while (place.size() < size) place.push_back(dice.descriptor());
  return place;
}

// Another look at a place: some features are others, and of the rest some bits.
Place seen_again(TestDice& dice, const Place& place, int flips, int percent_other) {
  Place again;
  for (const Descriptor& d : place) {
    const bool other = dice.integer(0, 99) < percent_other;
    again.push_back(other ? dice.descriptor() : dice.flipped(d, flips));
  }
  return again;
}

struct Filled {
  PlaceIndex index;
  std::vector<Place> places;
};

Filled fill(TestDice& dice, std::uint32_t count) {
  Filled filled;
  for (std::uint32_t k = 0; k < count; ++k) {
    filled.places.push_back(random_place(dice));
    filled.index.add(KeyframeId(k), filled.places.back());
  }
  return filled;
}

TEST(PlaceIndex, FindsAPlaceThatIsSeenAgain) {
  TestDice dice(1);
  const Filled filled = fill(dice, 50);
  for (std::uint32_t k = 0; k < 50; ++k) {
    const Place again = seen_again(dice, filled.places[k], 20, 50);
    const std::vector<PlaceCandidate> found = filled.index.query(again, 5);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].keyframe, KeyframeId(k));
    EXPECT_GT(found[0].score, 0.2);
    // Random descriptors are never within 40 bits of each other.
    EXPECT_EQ(found.size(), 1U);
  }
}

TEST(PlaceIndex, ManyAtOnceAreTheSameAsOneByOne) {
  TestDice dice(9);
  Filled one_by_one = fill(dice, 40);
  std::vector<PlaceIndex::NewPlace> places;
  for (std::uint32_t k = 0; k < 40; ++k) {
    // They resemble each other, so that scores have many parts.
    one_by_one.places[k] = seen_again(dice, one_by_one.places[k == 0 ? 0 : k - 1], 10, 30);
    places.push_back({KeyframeId(k), one_by_one.places[k]});
  }
  one_by_one.index = PlaceIndex();
  PlaceIndex at_once;
  at_once.add(KeyframeId(0), places[0].descriptors);
  at_once.add(std::span<const PlaceIndex::NewPlace>(places).subspan(1));
  for (const PlaceIndex::NewPlace& place : places) {
    one_by_one.index.add(place.keyframe, place.descriptors);
  }
  at_once.remove(KeyframeId(3));
  one_by_one.index.remove(KeyframeId(3));
  for (const Place& place : one_by_one.places) {
    const std::vector<PlaceCandidate> found = at_once.query(place, 40);
    EXPECT_GE(found.size(), 2U);
    EXPECT_EQ(found, one_by_one.index.query(place, 40));
  }
}

TEST(PlaceIndex, FindsNothingInAnUnknownPlace) {
  TestDice dice(2);
  const Filled filled = fill(dice, 50);
  EXPECT_TRUE(filled.index.query(random_place(dice), 5).empty());
  EXPECT_TRUE(filled.index.query({}, 5).empty());
  EXPECT_TRUE(PlaceIndex().query(filled.places[0], 5).empty());
}

// Worked by hand: of 10 features 6 are in the first place and 3 of these in the second as well; of
// 2 places, one with both has weight 1 - ln 2 / ln 3 and one alone has weight 1.
TEST(PlaceIndex, ScoresWeighByHowRareAFeatureIs) {
  TestDice dice(3);
  const Place query = random_place(dice, 10);
  PlaceIndex index;
  index.add(KeyframeId(7), std::span(query).first(6));
  index.add(KeyframeId(3), std::span(query).first(3));
  const double both = 1 - std::log(2.0) / std::log(3.0);
  const std::vector<PlaceCandidate> found = index.query(query, 5);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].keyframe, KeyframeId(7));
  EXPECT_NEAR(found[0].score, (3 * both + 3) / 10, 1e-12);
  EXPECT_EQ(found[1].keyframe, KeyframeId(3));
  EXPECT_NEAR(found[1].score, 3 * both / 10, 1e-12);
  EXPECT_EQ(index.query(query, 1).size(), 1U);
}

// Against the definition, by comparing all with all.
TEST(PlaceIndex, FindsAllLikeDescriptorsThatShareAKey) {
  TestDice dice(4);
  const PlaceOptions options;
  const Place base = random_place(dice, 300);
  const Place query = seen_again(dice, base, 30, 0);
  PlaceIndex index(options);
  index.add(KeyframeId(0), base);
  int expected = 0;
  for (std::size_t i = 0; i < base.size(); ++i) {
    bool shares = false;
    for (int k = 0; k < options.keys; ++k) {
      bool same = true;
      for (int b = k * options.key_bits; b < (k + 1) * options.key_bits; ++b) {
        const auto bit = static_cast<unsigned>(b);
        same = same && ((base[i][bit / 64U] ^ query[i][bit / 64U]) >> (bit % 64U) & 1U) == 0;
      }
      shares = shares || same;
    }
    const bool alike = hamming_distance(base[i], query[i]) <= options.max_distance;
    expected += shares && alike ? 1 : 0;
  }
  const std::vector<PlaceCandidate> found = index.query(query, 1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_GT(expected, 50);
  EXPECT_LT(expected, 290);
  EXPECT_NEAR(found[0].score, expected / 300.0, 1e-12);
}

TEST(PlaceIndex, EdgesThatLookAlikeDoNotVote) {
  TestDice dice(5);
  const Descriptor edge = dice.descriptor();
  Place wall = random_place(dice, 100), other = random_place(dice, 100);
  for (int i = 0; i < 100; ++i) {
    wall.push_back(dice.flipped(edge, 3));
    other.push_back(dice.flipped(edge, 3));
  }
  PlaceIndex index;
  index.add(KeyframeId(0), wall);
  const std::vector<PlaceCandidate> found = index.query(other, 1);
  EXPECT_TRUE(found.empty() || found[0].score < 0.1);
  EXPECT_GT(index.query(wall, 1)[0].score, 0.45);
}

TEST(PlaceIndex, RemovedPlacesAreGone) {
  TestDice dice(6);
  Filled filled = fill(dice, 20);
  filled.index.remove(KeyframeId(4));
  filled.index.remove(KeyframeId(4));
  EXPECT_FALSE(filled.index.has(KeyframeId(4)));
  EXPECT_EQ(filled.index.size(), 19U);
  EXPECT_TRUE(filled.index.query(filled.places[4], 5).empty());
  filled.index.add(KeyframeId(4), filled.places[4]);
  EXPECT_EQ(filled.index.query(filled.places[4], 5)[0].keyframe, KeyframeId(4));
}

TEST(PlaceIndex, LeftOutPlacesDoNotCount) {
  TestDice dice(7);
  const Place place = random_place(dice);
  PlaceIndex all, without;
  for (std::uint32_t k = 0; k < 4; ++k) {
    const Place again = seen_again(dice, place, 10, 30);
    all.add(KeyframeId(k), again);
    if (k % 2 == 0) without.add(KeyframeId(k), again);
  }
  const std::vector<KeyframeId> left_out = {KeyframeId(3), KeyframeId(1), KeyframeId(99)};
  EXPECT_EQ(all.query(place, 9, left_out), without.query(place, 9));
  EXPECT_EQ(without.query(place, 9).size(), 2U);
}

// Places come in any order, some go and come again: the same bits.
TEST(PlaceIndex, AnswerDependsOnTheContentAlone) {
  TestDice dice(8);
  const Place place = random_place(dice);
  std::vector<Place> places;
  for (int k = 0; k < 30; ++k) places.push_back(seen_again(dice, place, 15, 3 * k));
  PlaceIndex forwards, backwards;
  for (std::uint32_t k = 0; k < 30; ++k) forwards.add(KeyframeId(k), places[k]);
  for (std::uint32_t k = 30; k-- > 0;) backwards.add(KeyframeId(k), places[k]);
  for (std::uint32_t k = 5; k < 15; ++k) backwards.remove(KeyframeId(k));
  for (std::uint32_t k = 5; k < 15; ++k) backwards.add(KeyframeId(k), places[k]);
  const std::vector<PlaceCandidate> found = forwards.query(place, 40);
  EXPECT_EQ(found.size(), 30U);
  EXPECT_EQ(found, backwards.query(place, 40));
  EXPECT_TRUE(std::ranges::is_sorted(found, std::ranges::greater{}, &PlaceCandidate::score));
}

TEST(PlaceIndex, EqualScoresAreInTheOrderOfIds) {
  TestDice dice(9);
  const Place place = random_place(dice);
  PlaceIndex index;
  for (const std::uint32_t k : {5U, 2U, 9U, 0U}) index.add(KeyframeId(k), place);
  const std::vector<PlaceCandidate> found = index.query(place, 3);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].keyframe, KeyframeId(0));
  EXPECT_EQ(found[1].keyframe, KeyframeId(2));
  EXPECT_EQ(found[2].keyframe, KeyframeId(5));
}

}  // namespace
}  // namespace stillmap
