// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/static_depth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/depth_islands.hpp"

namespace stillmap {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

int known(const cv::Mat1f& depth) {
  int count = 0;
  for (const float z : depth) count += z > 0 ? 1 : 0;
  return count;
}

/// Equal images, where NaN equals NaN.
void expect_equal(const cv::Mat1f& a, const cv::Mat1f& b) {
  ASSERT_EQ(a.size(), b.size());
  for (int row = 0; row < a.rows; ++row) {
    for (int x = 0; x < a.cols; ++x) {
      const bool both_nan = a(row, x) != a(row, x) && b(row, x) != b(row, x);
      ASSERT_TRUE(a(row, x) == b(row, x) || both_nan) << row << " " << x;
    }
  }
}

/// Eqs. (11)-(12) with a growing threshold and without missing depth.
cv::Mat1f brute_force_edges(const cv::Mat1f& depth, const DepthEdgesConfig& config) {
  cv::Mat1f kept = depth.clone();
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      std::vector<float> window;
      for (const auto& [row, x] : {std::pair(v, u), {v, u + 1}, {v + 1, u}, {v + 1, u + 1}}) {
        if (row >= depth.rows || x >= depth.cols) continue;
        const float z = depth(row, x);
        if (z > 0 && z < kInfinity) window.push_back(z);
      }
      if (window.empty()) continue;
      const auto [least, greatest] = std::ranges::minmax(window);
      const double z = static_cast<double>(least);
      const double limit = std::max(config.step_m, config.step_per_m * z * z);
      if (static_cast<double>(greatest - least) > limit) kept(v, u) = 0;
    }
  }
  return kept;
}

/// Eqs. (11)-(12) to the letter.
cv::Mat1f brute_force_fixed_edges(const cv::Mat1f& depth, double step_m) {
  cv::Mat1f kept = depth.clone();
  for (int v = 0; v + 1 < depth.rows; ++v) {
    for (int u = 0; u + 1 < depth.cols; ++u) {
      double least = 0, greatest = 0;
      cv::minMaxLoc(depth(cv::Rect(u, v, 2, 2)), &least, &greatest);
      if (greatest - least > step_m) kept(v, u) = 0;
    }
  }
  return kept;
}

/// Eq. (13) with a flood fill.
cv::Mat1f brute_force_islands(const cv::Mat1f& depth, std::size_t min_pixels) {
  cv::Mat1f kept = depth.clone();
  cv::Mat1b seen(depth.size(), std::uint8_t{0});
  for (int row = 0; row < depth.rows; ++row) {
    for (int x = 0; x < depth.cols; ++x) {
      std::vector<cv::Point> patch{{x, row}};
      for (std::size_t next = 0; next < patch.size(); ++next) {
        const cv::Point p = patch[next];
        const bool inside = p.x >= 0 && p.y >= 0 && p.x < depth.cols && p.y < depth.rows;
        if (!inside || seen(p) != 0 || !(depth(p) > 0)) {
          patch.erase(patch.begin() + static_cast<std::ptrdiff_t>(next--));
          continue;
        }
        seen(p) = 1;
        for (const cv::Point step : {cv::Point(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
          patch.push_back(p + step);
        }
      }
      if (patch.size() >= min_pixels) continue;
      for (const cv::Point& p : patch) kept(p) = 0;
    }
  }
  return kept;
}

/// Patches of few depths with noise, gaps and nonsense between them.
cv::Mat1f random_depth(std::uint32_t seed, double share_missing) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> share(0, 1);
  cv::Mat1f depth(30, 41);
  for (float& z : depth) {
    const double level = 1.0 + 1.3 * std::floor(3 * share(rng) * share(rng));
    z = static_cast<float>(level + 0.12 * share(rng));
    if (share(rng) < share_missing) z = 0;
    if (share(rng) < 0.02) z = kNaN;
    if (share(rng) < 0.02) z = kInfinity;
    if (share(rng) < 0.02) z = -1;
  }
  return depth;
}

TEST(DepthEdges, AgreeWithBruteForce) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const cv::Mat1f depth = random_depth(seed, 0.3);
    for (const DepthEdgesConfig& config : {DepthEdgesConfig{0.1, 0.0}, {0.1, 0.02}, {0.0, 0.3}}) {
      const cv::Mat1f kept = without_edges(depth, config);
      expect_equal(kept, brute_force_edges(depth, config));
      EXPECT_GT(known(kept), 0);
      EXPECT_LT(known(kept), known(depth));
    }
  }
}

TEST(DepthEdges, TheUpperLeftPixelOfAWindowGoes) {
  cv::Mat1f depth(4, 6, 1.0F);
  depth(cv::Rect(3, 0, 3, 4)).setTo(1.2F);  // columns 3 to 5 are farther
  depth(3, 0) = 0;                          // missing, no edge
  const cv::Mat1f kept = without_edges(depth, {0.1, 0});
  for (int row = 0; row < 4; ++row) {
    for (int x = 0; x < 6; ++x) {
      EXPECT_EQ(kept(row, x), x == 2 ? 0.0F : depth(row, x)) << row << " " << x;
    }
  }
  expect_equal(without_edges(depth, {0.21, 0}), depth);
}

TEST(DepthEdges, AGrowingThresholdKeepsFarNoise) {
  std::mt19937 rng(4);
  std::normal_distribution<float> noise(0, 0.0015F * 25);
  cv::Mat1f wall(120, 160);
  for (float& z : wall) z = 5.0F + noise(rng);
  EXPECT_LT(known(without_edges(wall, {0.1, 0})), 19200 * 0.8);
  EXPECT_GT(known(without_edges(wall, {0.1, 0.01})), 19200 * 0.99);
  // What stands a third of a metre before it is still cut out.
  for (int row = 0; row < wall.rows; ++row) {
    for (int x = 40; x < 80; ++x) wall(row, x) -= 0.5F;
  }
  const cv::Mat1f kept = without_edges(wall, {0.1, 0.01});
  EXPECT_LT(known(kept.col(39)), 10);
  EXPECT_LT(known(kept.col(79)), 10);
}

TEST(DepthIslands, AgreeWithBruteForce) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const cv::Mat1f depth = random_depth(seed, 0.42);
    for (const std::size_t least : {2U, 9U, 40U}) {
      cv::Mat1f expected = brute_force_islands(depth, least);
      expected.setTo(0, ~(expected > 0));
      const cv::Mat1f kept = without_islands(depth, static_cast<double>(least));
      expect_equal(kept, expected);
      EXPECT_LT(known(kept), known(depth));
    }
  }
}

TEST(DepthIslands, JoinsPatchesThatMeetLate) {
  // A comb: teeth of two pixels that only the last row joins.
  cv::Mat1f comb(3, 9, 0.0F);
  for (int x = 0; x < 9; x += 2) comb(cv::Rect(x, 0, 1, 2)).setTo(2.0F);
  EXPECT_EQ(known(without_islands(comb, 3)), 0);
  comb.row(2).setTo(2.0F);
  EXPECT_EQ(known(without_islands(comb, 19)), 19);
  EXPECT_EQ(known(without_islands(comb, 20)), 0);
}

TEST(StaticDepth, EachStepOnlyWhenAsked) {
  // A wall at 3 m, its right half at 7 m, a small thing at 1 m, somebody on the left.
  cv::Mat1f depth(48, 64, 3.0F);
  depth(cv::Rect(40, 0, 24, 48)).setTo(7.0F);
  depth(cv::Rect(20, 20, 4, 4)).setTo(1.0F);
  depth(0, 12) = kNaN;
  cv::Mat1b dynamic(depth.size(), std::uint8_t{0});
  dynamic(cv::Rect(0, 0, 10, 48)).setTo(3);

  StaticDepthConfig config;
  const cv::Mat1f plain = static_depth(depth, Mask(dynamic), config);
  EXPECT_EQ(known(plain), 30 * 48 - 1);
  EXPECT_EQ(known(plain(cv::Rect(0, 0, 10, 48))), 0);
  EXPECT_EQ(plain(0, 12), 0.0F);
  EXPECT_EQ(plain(22, 22), 1.0F);
  EXPECT_EQ(known(static_depth(depth, {}, config)), 40 * 48 - 1);

  config.edges = "fixed";
  const cv::Mat1f cut = static_depth(depth, Mask(dynamic), config);
  // The rim before the far wall is gone too, and the ring around the small thing: the pixels whose
  // window has it in part, which are its own lower right ones and those left and above.
  EXPECT_EQ(known(cut), 29 * 48 - 1 - (25 - 9));
  EXPECT_EQ(cut(22, 22), 1.0F);

  config.islands = "on";
  config.min_island_share = 17.0 / (48 * 64);
  const cv::Mat1f clean = static_depth(depth, Mask(dynamic), config);
  EXPECT_EQ(clean(22, 22), 0.0F);
  EXPECT_EQ(known(clean), 29 * 48 - 1 - 25);

  config.max_depth_m = 8;
  EXPECT_EQ(known(static_depth(depth, Mask(dynamic), config)), 29 * 48 - 1 - 25 + 24 * 48);
}

// A hole, a step of 20 cm and one of 9 cm: the letter of the article takes missing depth for 0.
TEST(DepthEdges, OfTheArticleByHand) {
  cv::Mat1f depth = (cv::Mat_<float>(3, 4) << 2.0F,
                     2.0F,
                     2.2F,
                     2.29F,  //
                     2.0F,
                     2.0F,
                     2.2F,
                     2.29F,  //
                     2.0F,
                     0.0F,
                     2.2F,
                     2.29F);
  const cv::Mat1f kept = (cv::Mat_<float>(3, 4) << 2.0F,
                          0.0F,
                          2.2F,
                          2.29F,  //
                          0.0F,
                          0.0F,
                          2.2F,
                          2.29F,  //
                          2.0F,
                          0.0F,
                          2.2F,
                          2.29F);
  expect_equal(without_fixed_edges(depth, 0.1), kept);
}

TEST(DepthEdges, OfTheArticleAgreeWithBruteForce) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    cv::Mat1f depth = random_depth(seed, 0.3);
    for (float& z : depth) z = z > 0 && z < kInfinity ? z : 0.0F;
    expect_equal(without_fixed_edges(depth, 0.1), brute_force_fixed_edges(depth, 0.1));
  }
}

// Half of a wall is 5.9 m away, the other 6.1 m: an island only if the cut at 6 m came first.
TEST(StaticDepth, FarDepthIsCutLast) {
  cv::Mat1f depth(10, 20, 5.96F);
  depth.colRange(5, 20).setTo(6.04F);
  StaticDepthConfig config;
  config.edges = "fixed";
  config.islands = "on";
  config.min_island_share = 0.5;
  EXPECT_EQ(known(static_depth(depth, {}, config)), 50);
}

TEST(StaticDepth, TheGrowingThresholdOnlyWhereAskedFor) {
  cv::Mat1f depth(10, 10, 5.0F);
  depth.colRange(5, 10).setTo(5.2F);
  StaticDepthConfig config;
  config.edges = "growing";
  EXPECT_EQ(known(static_depth(depth, {}, config)), 100);
  config.edges = "fixed";
  EXPECT_EQ(known(static_depth(depth, {}, config)), 91);  // the last row has no window
}

TEST(StaticDepth, RefusesAMaskOfAnotherSize) {
  EXPECT_THROW((void)static_depth(cv::Mat1f(4, 4, 1.0F), Mask(cv::Mat1b(4, 5)), {}), InternalError);
  EXPECT_TRUE(static_depth(cv::Mat1f(), {}, {}).empty());
}

}  // namespace
}  // namespace stillmap
