// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/ransac.hpp"

#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

// y = slope x + offset, in whole numbers.
struct Line {
  int slope = 0, offset = 0;
};

struct Points {
  std::vector<int> y;  // at x = 0, 1, 2, ...

  [[nodiscard]] std::optional<Line> through(const Sample<2>& sample) const {
    const int x0 = static_cast<int>(sample[0]), x1 = static_cast<int>(sample[1]);
    const int rise = y[sample[1]] - y[sample[0]];
    if (x0 == x1 || rise % (x1 - x0) != 0) return std::nullopt;
    const int slope = rise / (x1 - x0);
    return Line{slope, y[sample[0]] - slope * x0};
  }
  [[nodiscard]] int on(const Line& line) const {
    int count = 0;
    for (int x = 0; x < static_cast<int>(y.size()); ++x) {
      count += y[static_cast<std::size_t>(x)] == line.slope * x + line.offset ? 1 : 0;
    }
    return count;
  }
};

// 3 x + 2 with every third point elsewhere.
Points mostly_on_a_line() {
  Points points;
  for (int x = 0; x < 30; ++x) points.y.push_back(x % 3 == 0 ? 100 + x * x : 3 * x + 2);
  return points;
}

TEST(Ransac, FindsTheLineOfMostPoints) {
  const Points points = mostly_on_a_line();
  std::mt19937 rng(1);
  const auto propose = [&] { return points.through(draw_with_replacement<2>(rng, 30)); };
  const auto support = [&](const Line& line) { return points.on(line); };
  const auto found = ransac(100, 10, propose, support);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->model.slope, 3);
  EXPECT_EQ(found->model.offset, 2);
  EXPECT_EQ(found->support, 20);
  EXPECT_FALSE(ransac(100, 20, propose, support));  // no more than the least
}

TEST(Ransac, KeepsTheEarliestOfEqualModels) {
  int proposed = 0;
  const auto found = ransac(
      10,
      0,
      [&] { return std::optional(proposed++); },
      [](int model) { return std::min(model, 4); });
  ASSERT_TRUE(found);
  EXPECT_EQ(found->model, 4);
  EXPECT_EQ(proposed, 10);
}

TEST(Ransac, StopsWhenEnoughHasBeenDrawn) {
  int proposed = 0;
  const auto propose = [&] { return std::optional(++proposed); };
  const auto support = [](int model) { return model == 3 ? 1 : 0; };
  EXPECT_EQ(ransac(100, 0, propose, support, [](int) { return 5; })->model, 3);
  EXPECT_EQ(proposed, 5);
  proposed = 0;
  EXPECT_EQ(ransac(100, 0, propose, support, [](int) { return 1; })->model, 3);
  EXPECT_EQ(proposed, 3);
}

TEST(Ransac, NeedsAsManyIterationsAsTheFormulaSays) {
  // Half are inliers, two to a sample: ln 0.005 / ln 0.75 = 18.4.
  EXPECT_EQ(ransac_iterations(50, 100, 2, 1000), 19);
  EXPECT_EQ(ransac_iterations(50, 100, 2, 10), 10);
  EXPECT_EQ(ransac_iterations(100, 100, 8, 1000), 1);
  EXPECT_EQ(ransac_iterations(0, 100, 8, 1000), 1000);
}

TEST(Ransac, DrawsAllIndicesAndNoneTwiceWithoutReplacement) {
  std::mt19937 rng(2);
  std::set<std::uint32_t> drawn;
  for (int i = 0; i < 200; ++i) {
    const Sample<8> sample = draw_without_replacement<8>(rng, 9);
    EXPECT_EQ(std::set<std::uint32_t>(sample.begin(), sample.end()).size(), 8U);
    drawn.insert(sample.begin(), sample.end());
  }
  EXPECT_EQ(drawn.size(), 9U);
  EXPECT_EQ(*drawn.rbegin(), 8U);
}

}  // namespace
}  // namespace stillmap
