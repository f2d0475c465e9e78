// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/map/covisibility.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/random_map.hpp"

namespace stillmap {
namespace {

// By brute force over all pairs: (-shared, id), sorted.
std::vector<std::pair<int, KeyframeId>> sharing(const Map& map,
                                                const std::vector<LandmarkId>& landmarks) {
  std::vector<std::pair<int, KeyframeId>> result;
  for (const auto& [id, keyframe] : map.keyframes()) {
    int shared = 0;
    for (const LandmarkId landmark : landmarks) {
      if (landmark.valid()) {
        shared += static_cast<int>(std::ranges::count(keyframe.landmarks, landmark));
      }
    }
    if (shared > 0) result.emplace_back(-shared, id);
  }
  std::ranges::sort(result);
  return result;
}

std::vector<std::pair<int, KeyframeId>> plain(const std::vector<CovisibleKeyframe>& found) {
  std::vector<std::pair<int, KeyframeId>> result;
  for (const CovisibleKeyframe& c : found) result.emplace_back(-c.shared_landmarks, c.id);
  return result;
}

TEST(Covisibility, EqualsBruteForce) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    std::mt19937 rng(seed);
    Map map = random_map(15, 250, rng);
    map.remove_keyframe(KeyframeId(7), KeyframeId(2));
    std::size_t pairs = 0;
    for (const auto& [id, keyframe] : map.keyframes()) {
      std::vector<std::pair<int, KeyframeId>> expected = sharing(map, keyframe.landmarks);
      EXPECT_EQ(plain(keyframes_seeing(map, keyframe.landmarks)), expected);
      std::erase_if(expected, [own = id](const auto& entry) { return entry.second == own; });
      EXPECT_EQ(plain(covisible_keyframes(map, id)), expected);
      pairs += expected.size();
    }
    EXPECT_GT(pairs, 20U);
  }
}

TEST(Covisibility, OfAWindowCountsOnlyItsLandmarks) {
  std::mt19937 rng(2);
  const Map map = random_map(15, 250, rng);
  const std::vector<KeyframeId> core = {KeyframeId(3)};
  const Map window = map.window(core);
  EXPECT_EQ(plain(covisible_keyframes(window, core[0])), plain(covisible_keyframes(map, core[0])));
}

TEST(Covisibility, OfNothingIsNothing) {
  const Map empty(test_scales());
  EXPECT_TRUE(keyframes_seeing(empty, {}).empty());
  std::mt19937 rng(2);
  const Map map = random_map(3, 20, rng);
  const std::vector<LandmarkId> gone = {LandmarkId(9999), LandmarkId{}};
  EXPECT_TRUE(keyframes_seeing(map, gone).empty());
}

}  // namespace
}  // namespace stillmap
