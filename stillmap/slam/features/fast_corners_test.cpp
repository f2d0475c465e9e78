// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/fast_corners.hpp"

#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>

#include "stillmap/core/error.hpp"
#include "tests/support/feature_images.hpp"

namespace stillmap {
namespace {

// As the header has it, pixel by pixel.
int score_by_definition(const cv::Mat1b& image, int x, int y) {
  const std::vector<cv::Point> circle = {{0, 3},
                                         {1, 3},
                                         {2, 2},
                                         {3, 1},
                                         {3, 0},
                                         {3, -1},
                                         {2, -2},
                                         {1, -3},
                                         {0, -3},
                                         {-1, -3},
                                         {-2, -2},
                                         {-3, -1},
                                         {-3, 0},
                                         {-3, 1},
                                         {-2, 2},
                                         {-1, 3}};
  for (int t = 255; t > 0; --t) {
    for (const int sign : {1, -1}) {
      for (std::size_t begin = 0; begin < 16; ++begin) {
        bool all = true;
        for (std::size_t k = 0; k < 9; ++k) {
          const cv::Point at = cv::Point(x, y) + circle[(begin + k) % 16];
          all = all && sign * (image(at) - image(y, x)) > t;
        }
        if (all) return t;
      }
    }
  }
  return 0;
}

cv::Mat1b noise(cv::Size size, std::uint32_t seed) {
  TestDice dice(seed);
  cv::Mat1b image(size);
  // Mostly the ends of the scale: else few corners.
  for (std::uint8_t& value : image) {
    value = static_cast<std::uint8_t>(dice.integer(0, 3) < 3 ? 255 * dice.integer(0, 1)
                                                             : dice.integer(0, 255));
  }
  return image;
}

TEST(CornerScores, AreAsDefined) {
  int corners = 0;
  for (const cv::Mat1b& image : {noise({97, 60}, 1), textured_image(90, 75, 2).mat}) {
    const cv::Mat1b scores = corner_scores(image);
    ASSERT_EQ(scores.size(), image.size());
    const cv::Rect inside(3, 3, image.cols - 6, image.rows - 6);
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        const int expected =
            inside.contains(cv::Point(x, y)) ? score_by_definition(image, x, y) : 0;
        ASSERT_EQ(scores(y, x), expected) << x << ", " << y;
        corners += expected > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(corners, 500);
}

TEST(CornerScores, OfImagesWithoutInsideAreZero) {
  for (const cv::Size size : {cv::Size(6, 50), cv::Size(50, 6), cv::Size(1, 1)}) {
    EXPECT_EQ(cv::countNonZero(corner_scores(noise(size, 3))), 0);
  }
}

void expect_what_opencv_finds(const cv::Mat1b& image, const cv::Rect& area, int threshold) {
  constexpr int kRim = kCornerCircleRadiusPx;
  const cv::Rect with_rim(
      area.x - kRim, area.y - kRim, area.width + 2 * kRim, area.height + 2 * kRim);
  std::vector<cv::KeyPoint> expected;
  cv::FAST(image(with_rim), expected, threshold, true);
  const std::vector<cv::KeyPoint> found = local_maxima(corner_scores(image), area, threshold);
  ASSERT_EQ(found.size(), expected.size()) << area << " " << threshold;
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].pt, expected[i].pt + cv::Point2f(with_rim.tl())) << area << " " << threshold;
    ASSERT_EQ(found[i].response, expected[i].response) << area << " " << threshold;
    ASSERT_EQ(found[i].size, expected[i].size);
  }
}

TEST(LocalMaxima, OfScoresAreTheCornersThatOpenCvFinds) {
  TestDice dice(5);
  for (std::uint32_t seed = 1; seed < 30; ++seed) {
    const cv::Size size(dice.integer(40, 200), dice.integer(40, 150));
    const cv::Mat1b image =
        seed % 2 == 0 ? noise(size, seed) : textured_image(size.width, size.height, seed).mat;
    const int x = dice.integer(3, 15), y = dice.integer(3, 15);
    const cv::Rect area(x, y, size.width - x - dice.integer(3, 20), size.height - y - 3);
    for (const int threshold : {1, 7, 20, 100, 254}) {
      expect_what_opencv_finds(image, area, threshold);
    }
  }
}

TEST(LocalMaxima, OfAnEmptyAreaAreNoneAndOfOneOutsideAreRefused) {
  const cv::Mat1b scores = corner_scores(noise({50, 50}, 4));
  EXPECT_TRUE(local_maxima(scores, cv::Rect(10, 10, 0, 0), 7).empty());
  EXPECT_TRUE(local_maxima(scores, cv::Rect(10, 10, 0, 20), 7).empty());
  EXPECT_THROW((void)local_maxima(scores, cv::Rect(30, 30, 21, 5), 7), InternalError);
  EXPECT_THROW((void)local_maxima(scores, cv::Rect(-1, 30, 5, 5), 7), InternalError);
  EXPECT_THROW((void)local_maxima(scores, cv::Rect(30, 30, 5, 5), 0), InternalError);
}

}  // namespace
}  // namespace stillmap
