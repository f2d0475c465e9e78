// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/candidates.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/perception/detections/box_overlap.hpp"

namespace stillmap {
namespace {

TEST(Overlap, ByHand) {
  const PixelBox box{0, 0, 4, 2};
  EXPECT_DOUBLE_EQ(box_iou(box, box), 1);
  EXPECT_DOUBLE_EQ(box_iou(box, {2, 0, 6, 2}), 4.0 / 12);
  EXPECT_DOUBLE_EQ(box_iou(box, {1, 1, 2, 4}), 1.0 / 10);
  EXPECT_DOUBLE_EQ(box_iou(box, {4, 0, 6, 2}), 0);
  EXPECT_DOUBLE_EQ(box_iou(box, {9, 9, 10, 10}), 0);
}

TEST(SuppressOverlaps, BestOfEachClassStays) {
  const Candidate best{3, 0.9F, {0, 0, 10, 10}, 5};
  const Candidate same_place{3, 0.8F, {1, 0, 11, 10}, 6};  // overlap 9 / 11
  const Candidate elsewhere{3, 0.7F, {6, 0, 16, 10}, 7};   // overlap 4 / 16
  const Candidate other_class{4, 0.6F, {0, 0, 10, 10}, 8};
  EXPECT_THAT(suppress_overlaps({other_class, elsewhere, same_place, best}, 0.5),
              testing::ElementsAre(best, elsewhere, other_class));
  EXPECT_THAT(suppress_overlaps({elsewhere, best}, 0.2), testing::ElementsAre(best));
}

TEST(SuppressOverlaps, EqualScoresInTheOrderOfTheDetector) {
  const Candidate first{0, 0.5F, {0, 0, 10, 10}, 1};
  const Candidate second{0, 0.5F, {0, 0, 10, 10}, 2};
  EXPECT_THAT(suppress_overlaps({second, first}, 0.5), testing::ElementsAre(first));
}

TEST(SuppressOverlaps, DropsWhatIsNoBox) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const float no_score = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(suppress_overlaps({{0, 0.9F, {0, 0, kNan, 10}, 0},
                                 {0, 0.9F, {0, 0, kInfinity, 10}, 1},
                                 {0, 0.9F, {5, 0, 5, 10}, 2},
                                 {0, 0.9F, {0, 10, 5, 0}, 3},
                                 {0, no_score, {0, 0, 5, 5}, 4}},
                                0.5),
              testing::IsEmpty());
}

// Kept boxes do not overlap, and every dropped box overlaps a better one that was kept.
TEST(SuppressOverlaps, PropertiesOnRandomBoxes) {
  std::mt19937 random(3);
  const auto draw = [&](int end) {
    return static_cast<int>(random() % static_cast<unsigned>(end));
  };
  std::vector<Candidate> candidates;
  for (int i = 0; i < 300; ++i) {
    const double x = draw(100), y = draw(100);
    const float score = static_cast<float>(draw(1000)) / 1000.0F;
    candidates.push_back({draw(3), score, {x, y, x + 1 + draw(60), y + 1 + draw(60)}, i});
  }
  const std::vector<Candidate> kept = suppress_overlaps(candidates, 0.4);
  EXPECT_LT(kept.size(), candidates.size());
  for (const Candidate& candidate : candidates) {
    const bool stayed = std::ranges::find(kept, candidate) != kept.end();
    const bool beaten = std::ranges::any_of(kept, [&](const Candidate& other) {
      return other.source != candidate.source && other.label == candidate.label &&
             other.score >= candidate.score && box_iou(other.box, candidate.box) > 0.4;
    });
    EXPECT_NE(stayed, beaten);
  }
}

TEST(ClipBox, ToTheImage) {
  const cv::Size image(640, 480);
  EXPECT_EQ(clip_box({-5, 10.5, 700, 500}, image), (PixelBox{0, 10.5, 640, 480}));
  EXPECT_EQ(clip_box({700, 10, 800, 20}, image), std::nullopt);
  EXPECT_EQ(clip_box({639.75, 10, 800, 20}, image), std::nullopt);
}

TEST(PixelsIn, AreThoseWhoseMiddleIsInside) {
  const cv::Size image(20, 10);
  EXPECT_EQ(pixels_in({2, 3, 5, 7}, image), cv::Rect(2, 3, 3, 4));
  EXPECT_EQ(pixels_in({2.4, 3.6, 5.4, 7.6}, image), cv::Rect(2, 4, 3, 4));
  EXPECT_EQ(pixels_in({-100, -100, 100, 100}, image), cv::Rect(0, 0, 20, 10));
  EXPECT_EQ(pixels_in({30, 30, 40, 40}, image).area(), 0);
}

}  // namespace
}  // namespace stillmap
