// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/network_input.hpp"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace stillmap {
namespace {

void expect_near(const PixelBox& a, const PixelBox& b) {
  EXPECT_NEAR(a.x0, b.x0, 1e-9);
  EXPECT_NEAR(a.y0, b.y0, 1e-9);
  EXPECT_NEAR(a.x1, b.x1, 1e-9);
  EXPECT_NEAR(a.y1, b.y1, 1e-9);
}

ColorImage noise(cv::Size size) {
  std::mt19937 random(7);
  cv::Mat3b image(size);
  for (cv::Vec3b& pixel : image) {
    const auto bits = static_cast<std::uint32_t>(random());
    pixel = cv::Vec3b(bits & 255U, (bits >> 8U) & 255U, (bits >> 16U) & 255U);
  }
  return ColorImage(image);
}

TEST(InputPlacement, WholeImageByHand) {
  const InputPlacement stretched = InputPlacement::stretch({640, 480}, {416, 208});
  expect_near(stretched.to_input({0, 0, 640, 480}), {0, 0, 416, 208});
  expect_near(stretched.to_input({320, 120, 640, 240}), {208, 52, 416, 104});
  // 640x480 in 416x416: 416x312 with 52 above and below.
  const InputPlacement letterboxed = InputPlacement::letterbox({640, 480}, {416, 416});
  expect_near(letterboxed.to_input({0, 0, 640, 480}), {0, 52, 416, 364});
  // 480x640: 312x416 with 52 at the left and the right.
  expect_near(InputPlacement::letterbox({480, 640}, {416, 416}).to_input({0, 0, 480, 640}),
              {52, 0, 364, 416});
  expect_near(InputPlacement::crop({-10, 20, 90, 120}, {200, 200}).to_input({-10, 20, 40, 70}),
              {0, 0, 100, 100});
}

TEST(InputPlacement, BackIsTheInverse) {
  const PixelBox box{-3.25, 17.5, 401.125, 477};
  for (const InputPlacement& placement :
       {InputPlacement::stretch({641, 479}, {416, 320}),
        InputPlacement::letterbox({641, 479}, {640, 384}),
        InputPlacement::crop({31, -7.5, 222, 183.5}, {256, 256}),
        InputPlacement::letterbox({641, 479}, {640, 384}).onto({160, 96})}) {
    expect_near(placement.to_image(placement.to_input(box)), box);
  }
}

TEST(InputPlacement, OntoASmallerPlane) {
  const InputPlacement placement =
      InputPlacement::letterbox({640, 480}, {416, 416}).onto({104, 52});
  expect_near(placement.to_input({0, 0, 640, 480}), {0, 6.5, 104, 45.5});
}

TEST(MakeInput, SameSizeIsTheImageItself) {
  const ColorImage image = noise({7, 5});
  const InputPlacement placement = InputPlacement::stretch({7, 5}, {7, 5});
  const Tensor first = make_input(image, placement, {});
  const Tensor last = make_input(image, placement, {.channels_last = true});
  EXPECT_THAT(first.shape, testing::ElementsAre(1, 3, 5, 7));
  EXPECT_THAT(last.shape, testing::ElementsAre(1, 5, 7, 3));
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x) {
      for (int c = 0; c < 3; ++c) {
        const float value = static_cast<float>(image.mat(y, x)[c]) / 255.0F;
        EXPECT_FLOAT_EQ(first.values[static_cast<std::size_t>((c * 5 + y) * 7 + x)], value);
        EXPECT_FLOAT_EQ(last.values[static_cast<std::size_t>((y * 7 + x) * 3 + c)], value);
      }
    }
  }
}

TEST(MakeInput, NormalisesEachChannelInItsOrder) {
  const ColorImage red(cv::Mat3b(1, 1, cv::Vec3b(255, 0, 51)));
  const InputPlacement placement = InputPlacement::stretch({1, 1}, {1, 1});
  const InputFormat format{.mean = {0.5F, 0.25F, 0.1F}, .deviation = {0.5F, 0.25F, 0.2F}};
  EXPECT_THAT(make_input(red, placement, format).values,
              testing::Pointwise(testing::FloatEq(), {1.0F, -1.0F, 0.5F}));
  InputFormat blue = format;
  blue.blue_first = true;
  EXPECT_THAT(make_input(red, placement, blue).values,
              testing::Pointwise(testing::FloatNear(1e-6F), {-0.6F, -1.0F, 4.5F}));
}

// cv::resize's bilinear interpolation of floats has the same middles of pixels.
TEST(MakeInput, StretchesAsOpenCvDoes) {
  const ColorImage image = noise({64, 48});
  cv::Mat3f floats, expected;
  image.mat.convertTo(floats, CV_32FC3);
  for (const cv::Size size : {cv::Size(41, 31), cv::Size(100, 90)}) {
    cv::resize(floats, expected, size, 0, 0, cv::INTER_LINEAR);
    const Tensor input =
        make_input(image, InputPlacement::stretch({64, 48}, size), {.channels_last = true});
    for (int i = 0; i < size.area(); ++i) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(input.values[static_cast<std::size_t>(i * 3 + c)] * 255,
                    expected(i / size.width, i % size.width)[c],
                    2e-3);
      }
    }
  }
}

TEST(MakeInput, PadsWhatIsOutside) {
  const ColorImage white(cv::Mat3b(2, 4, cv::Vec3b(255, 255, 255)));
  const Tensor input =
      make_input(white, InputPlacement::letterbox({4, 2}, {4, 4}), {.padding = 51});
  for (std::size_t i = 0; i < 48; ++i) {
    const std::size_t row = i % 16 / 4;
    EXPECT_FLOAT_EQ(input.values[i], row == 0 || row == 3 ? 0.2F : 1.0F);
  }
}

// A plane whose values are linear in the image's coordinates is met exactly between the middles of
// its outermost pixels.
TEST(SampleAtImage, IsExactOnAPlaneThatIsLinear) {
  const cv::Size image(640, 480);
  const InputPlacement onto = InputPlacement::letterbox(image, {416, 416}).onto({104, 104});
  cv::Mat1f plane(104, 104);
  for (int y = 0; y < 104; ++y) {
    for (int x = 0; x < 104; ++x) {
      const PixelBox point = onto.to_image({x + 0.5, y + 0.5, x + 0.5, y + 0.5});
      plane(y, x) = static_cast<float>(point.x0 + 1000 * point.y0);
    }
  }
  const cv::Rect region(100, 50, 300, 200);
  const cv::Mat1f sampled = sample_at_image(plane, onto, region, -1);
  for (int y = 0; y < region.height; y += 7) {
    for (int x = 0; x < region.width; x += 7) {
      const double expected = region.x + x + 0.5 + 1000 * (region.y + y + 0.5);
      EXPECT_NEAR(sampled(y, x), expected, 0.1);
    }
  }
}

TEST(SampleAtImage, OutsideThePlane) {
  const InputPlacement crop = InputPlacement::crop({2, 0, 4, 2}, {4, 4});
  const cv::Mat1f ones = cv::Mat1f::ones(4, 4);
  const cv::Mat1f sampled = sample_at_image(ones, crop, {0, 0, 6, 2}, -5);
  EXPECT_THAT(std::vector<float>(sampled.begin(), sampled.begin() + 6),
              testing::ElementsAre(-5, -5, 1, 1, -5, -5));
}

}  // namespace
}  // namespace stillmap
