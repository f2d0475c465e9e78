// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/patch_blur.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"
#include "tests/support/feature_images.hpp"

namespace stillmap {
namespace {

void expect_as_opencv(const cv::Mat1b& image) {
  cv::Mat1b expected;
  cv::GaussianBlur(
      image, expected, cv::Size(7, 7), 2, 2, cv::BORDER_REFLECT_101 | cv::BORDER_ISOLATED);
  const cv::Mat1b blurred = blurred_for_descriptors(image);
  ASSERT_EQ(blurred.size(), image.size());
  EXPECT_EQ(cv::norm(blurred, expected, cv::NORM_INF), 0.0) << image.size();
}

TEST(PatchBlur, GivesTheBitsOfOpenCv) {
  TestDice dice(1);
  for (int i = 0; i < 40; ++i) {
    const cv::Size size(dice.integer(4, 200), dice.integer(4, 90));
    cv::Mat1b noise(size);
    for (std::uint8_t& value : noise) {
      value =
          static_cast<std::uint8_t>(i % 2 == 0 ? dice.integer(0, 255) : 255 * dice.integer(0, 1));
    }
    expect_as_opencv(noise);
  }
  expect_as_opencv(textured_image(640, 480, 2).mat);
  expect_as_opencv(textured_image(300, 200, 3).mat(cv::Rect(17, 11, 150, 80)));  // of a larger one
}

TEST(PatchBlur, LeavesFlatImagesAndTheirEnds) {
  for (const int value : {0, 1, 128, 255}) {
    const cv::Mat1b flat(50, 70, static_cast<std::uint8_t>(value));
    EXPECT_EQ(cv::norm(blurred_for_descriptors(flat), flat, cv::NORM_INF), 0.0);
  }
}

TEST(PatchBlur, RefusesImagesWithNothingToMirror) {
  EXPECT_THROW((void)blurred_for_descriptors(cv::Mat1b(3, 50)), InternalError);
  EXPECT_THROW((void)blurred_for_descriptors(cv::Mat1b(50, 3)), InternalError);
}

}  // namespace
}  // namespace stillmap
