// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/depth_stability.hpp"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "stillmap/core/random.hpp"

namespace stillmap {
namespace {

constexpr double kTwoUnits = 2.0 / 4294967295.0;

/// A wall at `z`, whose depth is off by up to `noise` times depth squared.
DepthImage noisy_wall(float z, float noise, std::mt19937& rng) {
  cv::Mat1f depth(120, 160);
  for (float& d : depth) {
    const auto unit = static_cast<float>(static_cast<double>(rng()) * kTwoUnits - 1.0);
    d = z + noise * z * z * unit;
  }
  return DepthImage(depth);
}

/// Every tenth pixel, off the rim.
std::vector<Eigen::Vector2f> pixel_grid() {
  std::vector<Eigen::Vector2f> px;
  for (int y = 10; y < 110; y += 10) {
    for (int x = 10; x < 150; x += 10) {
      px.emplace_back(static_cast<float>(x), static_cast<float>(y));
    }
  }
  return px;
}

DepthStabilityConfig absolute() {
  DepthStabilityConfig config;
  config.relative = false;
  return config;
}

std::ptrdiff_t count(const std::vector<DepthStability>& all, DepthStability one) {
  return std::ranges::count(all, one);
}

TEST(DepthStability, AMissingPixelInTheBlockIsMissingDepthAndOneBesideItIsNot) {
  std::mt19937 rng(1);
  DepthImage depth = noisy_wall(2.0F, 0.002F, rng);
  depth.mat(51, 51) = 0;
  const std::vector<Eigen::Vector2f> px = {{50, 50}, {51, 51}, {53, 50}, {50.4F, 50.4F}, {20, 20}};
  const std::vector<DepthStability> found = judge_depth_stability(depth, px, absolute());
  EXPECT_EQ(found[0], DepthStability::kMissing);
  EXPECT_EQ(found[1], DepthStability::kMissing);
  EXPECT_NE(found[2], DepthStability::kMissing);
  EXPECT_EQ(found[3], DepthStability::kMissing);
  EXPECT_NE(found[4], DepthStability::kMissing);
}

// One pixel of each block is off by 1 .. 8 steps of a centimetre, the last by more. They have
// deviations d * sqrt(8) / 9: the median is that of 5 steps, the MAD, of {4,3,2,1,0,1,2,3,8 or 11},
// is 2, so the bound is 3 * 1.4826 * 2 = 8.9 steps.
TEST(DepthStability, TheBoundIsThreeScaledMadsByHand) {
  for (const auto& [last_step, expected] :
       {std::pair(13, DepthStability::kStable), std::pair(16, DepthStability::kUnstable)}) {
    cv::Mat1f depth(40, 120, 2.0F);
    std::vector<Eigen::Vector2f> px;
    for (int i = 1; i <= 9; ++i) {
      depth(20, 10 * i) = 2.0F + 0.01F * static_cast<float>(i == 9 ? last_step : i);
      px.emplace_back(static_cast<float>(10 * i), 20.0F);
    }
    const std::vector<DepthStability> found =
        judge_depth_stability(DepthImage(depth), px, absolute());
    EXPECT_EQ(found[8], expected) << last_step;
    EXPECT_EQ(count(found, DepthStability::kUnstable),
              expected == DepthStability::kUnstable ? 1 : 0);
  }
}

TEST(DepthStability, FeaturesOnADepthEdgeAreUnstableAndThoseOfTheWallsAreNot) {
  std::mt19937 rng(2);
  DepthImage depth = noisy_wall(2.0F, 0.002F, rng);
  const cv::Rect right(80, 0, 80, 120);
  noisy_wall(1.5F, 0.002F, rng).mat(right).copyTo(depth.mat(right));
  const std::vector<Eigen::Vector2f> px = pixel_grid();
  const std::vector<DepthStability> found = judge_depth_stability(depth, px, absolute());
  int wrong = 0;
  for (std::size_t i = 0; i < px.size(); ++i) {
    const bool on_edge = px[i].x() == 80.0F;
    if (on_edge) {
      EXPECT_EQ(found[i], DepthStability::kUnstable);
    }
    if (!on_edge && found[i] != DepthStability::kStable) ++wrong;
  }
  EXPECT_LE(wrong, 4);
}

// A fifth of the features are on a far wall, where a sensor's noise is nine times as large.
TEST(DepthStability, RelativeSpreadsKeepAFarWall) {
  std::mt19937 rng(3);
  DepthImage depth = noisy_wall(1.0F, 0.004F, rng);
  const cv::Rect far(125, 0, 35, 120);
  noisy_wall(3.0F, 0.004F, rng).mat(far).copyTo(depth.mat(far));
  std::vector<Eigen::Vector2f> px;
  for (const Eigen::Vector2f& p : pixel_grid()) {
    if (p.x() != 120.0F) px.push_back(p);
  }
  const auto unstable = [&](const DepthStabilityConfig& config) {
    return count(judge_depth_stability(depth, px, config), DepthStability::kUnstable);
  };
  EXPECT_GE(unstable(absolute()), 15);  // the whole far wall
  EXPECT_LE(unstable(DepthStabilityConfig{}), 5);
}

TEST(DepthStability, WhatLeavesTheImageOrIsNoNumberIsMissing) {
  cv::Mat1f depth(40, 40, 2.0F);
  depth(20, 20) = std::numeric_limits<float>::quiet_NaN();
  depth(30, 30) = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Eigen::Vector2f> px = {
      {0, 10}, {39, 10}, {10, 0}, {10, 39}, {-1e9F, 5}, {nan, 5}, {20, 20}, {30, 30}};
  for (const DepthStability one : judge_depth_stability(DepthImage(depth), px, absolute())) {
    EXPECT_EQ(one, DepthStability::kMissing);
  }
  EXPECT_TRUE(judge_depth_stability(DepthImage(depth), {}, absolute()).empty());
}

TEST(DepthStability, AWallWithoutNoiseIsStable) {
  const DepthImage depth(cv::Mat1f(120, 160, 2.0F));
  const std::vector<DepthStability> found = judge_depth_stability(depth, pixel_grid(), absolute());
  EXPECT_EQ(count(found, DepthStability::kStable), std::ssize(found));
}

}  // namespace
}  // namespace stillmap
