// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/mask_faults.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace stillmap {
namespace {

constexpr std::uint64_t kKeys = 200;

// A disc of radius 60 about (100, 100).
cv::Mat1b disc() {
  cv::Mat1b mask(200, 200, std::uint8_t{0});
  for (int v = 0; v < 200; ++v) {
    for (int u = 0; u < 200; ++u) {
      if (std::hypot(u - 100.0, v - 100.0) <= 60.0) mask(v, u) = 255;
    }
  }
  return mask;
}

bool same(const cv::Mat1b& a, const cv::Mat1b& b) {
  return cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(WanderingEdge, WithoutWaveIsErosion) {
  // Of a disc remains a disc, smaller by the loss.
  const cv::Mat1b moved = with_wandering_edge(disc(), 5.0, 0.0, 1);
  for (int v = 0; v < 200; ++v) {
    for (int u = 0; u < 200; ++u) {
      const double r = std::hypot(u - 100.0, v - 100.0);
      if (r < 54.0) {
        ASSERT_EQ(moved(v, u), 255) << u << ' ' << v;
      }
      if (r > 56.5) {
        ASSERT_EQ(moved(v, u), 0) << u << ' ' << v;
      }
    }
  }
}

TEST(WanderingEdge, OfNothingAndOfNoLengthChangesNothing) {
  EXPECT_TRUE(same(with_wandering_edge(disc(), 0.0, 0.0, 1), disc()));
  const cv::Mat1b nothing(30, 30, std::uint8_t{0});
  EXPECT_TRUE(same(with_wandering_edge(nothing, 2.0, 1.0, 1), nothing));
}

TEST(WanderingEdge, StaysWithinItsWanderingAndGoesBothWays) {
  int added = 0, removed = 0;
  for (std::uint64_t key = 0; key < 20; ++key) {
    const cv::Mat1b moved = with_wandering_edge(disc(), 1.0, 4.0, key);
    for (int v = 0; v < 200; ++v) {
      for (int u = 0; u < 200; ++u) {
        const double r = std::hypot(u - 100.0, v - 100.0);
        if (r < 60.0 - 5.0 - 1.5) {
          ASSERT_EQ(moved(v, u), 255);
        }
        if (r > 60.0 + 3.0 + 1.5) {
          ASSERT_EQ(moved(v, u), 0);
        }
        added += r > 60.0 && moved(v, u) != 0 ? 1 : 0;
        removed += r <= 60.0 && moved(v, u) == 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(added, 20 * 10);
  EXPECT_GT(removed, added);
}

TEST(WanderingEdge, LosesThinParts) {
  cv::Mat1b mask = disc();
  mask(cv::Rect(160, 98, 30, 4)).setTo(255);  // a stick of four pixels
  const cv::Mat1b moved = with_wandering_edge(mask, 2.5, 0.0, 1);
  EXPECT_EQ(cv::countNonZero(moved(cv::Rect(165, 0, 35, 200))), 0);
}

TEST(WanderingEdge, KeepsTheImagesBorder) {
  // What is cut off by the border has no edge there.
  const cv::Mat1b mask(50, 50, std::uint8_t{255});
  EXPECT_TRUE(same(with_wandering_edge(mask, 3.0, 1.0, 1), mask));
}

TEST(EndCutOff, TakesAnEndAwayAndAddsNothing) {
  std::set<int> sides;
  for (std::uint64_t key = 0; key < kKeys; ++key) {
    const cv::Mat1b mask = disc();
    const cv::Mat1b cut = with_end_cut_off(mask, key);
    EXPECT_EQ(cv::countNonZero(cut & ~mask), 0);
    const cv::Mat1b lost = mask & ~cut;
    const int count = cv::countNonZero(lost);
    EXPECT_GT(count, 0);
    EXPECT_LT(count, cv::countNonZero(mask) * 35 / 100);
    EXPECT_NE(cut(100, 100), 0) << "the middle stays";
    const cv::Moments moments = cv::moments(lost, true);
    const double dx = moments.m10 / moments.m00 - 100, dy = moments.m01 / moments.m00 - 100;
    sides.insert(std::abs(dx) > std::abs(dy) ? (dx > 0 ? 1 : -1) : (dy > 0 ? 2 : -2));
  }
  EXPECT_EQ(sides, (std::set<int>{-2, -1, 1, 2}));
}

TEST(Leak, AddsABlobAtTheEdge) {
  for (std::uint64_t key = 0; key < kKeys; ++key) {
    const cv::Mat1b mask = disc();
    const cv::Mat1b grown = with_leak(mask, key);
    EXPECT_EQ(cv::countNonZero(mask & ~grown), 0) << "nothing is lost";
    const cv::Mat1b added = grown & ~mask;
    const int count = cv::countNonZero(added);
    EXPECT_GT(count, 20);
    EXPECT_LT(count, cv::countNonZero(mask) / 8);
    cv::Mat1i labels;
    EXPECT_EQ(cv::connectedComponents(grown, labels), 2) << "in one piece with the mask";
  }
}

TEST(MaskFaults, DependOnTheKeyAlone) {
  const cv::Mat1b mask = disc();
  EXPECT_TRUE(same(with_leak(mask, 5), with_leak(mask, 5)));
  EXPECT_FALSE(same(with_leak(mask, 5), with_leak(mask, 6)));
  EXPECT_TRUE(same(with_end_cut_off(mask, 5), with_end_cut_off(mask, 5)));
  EXPECT_TRUE(same(with_wandering_edge(mask, 2, 2, 5), with_wandering_edge(mask.clone(), 2, 2, 5)));
  EXPECT_FALSE(same(with_wandering_edge(mask, 2, 2, 5), with_wandering_edge(mask, 2, 2, 6)));
  EXPECT_TRUE(same(mask, disc())) << "what is given is not written to";
}

TEST(MaskFaults, OfNothingAreNothing) {
  const cv::Mat1b nothing(20, 30, std::uint8_t{0});
  EXPECT_TRUE(same(with_leak(nothing, 1), nothing));
  EXPECT_TRUE(same(with_end_cut_off(nothing, 1), nothing));
}

TEST(MaskFaults, WorkOnOnePixel) {
  cv::Mat1b pixel(1, 1, std::uint8_t{255});
  for (std::uint64_t key = 0; key < 20; ++key) {
    EXPECT_EQ(with_leak(pixel, key)(0, 0), 255);
    (void)with_end_cut_off(pixel, key);
    (void)with_wandering_edge(pixel, 1.0, 1.0, key);
  }
}

}  // namespace
}  // namespace stillmap
