// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/texture.hpp"

#include <gtest/gtest.h>

namespace stillmap {
namespace {

// Two columns, two rows: red, green / blue, white.
MipTexture four_colors() {
  cv::Mat3b picture(2, 2);
  picture(0, 0) = {200, 0, 0};
  picture(0, 1) = {0, 100, 0};
  picture(1, 0) = {0, 0, 60};
  picture(1, 1) = {240, 240, 240};
  return MipTexture(picture);
}

constexpr TexelSum times_256(std::uint32_t r, std::uint32_t g, std::uint32_t b) {
  return {256U * r, 256U * g, 256U * b};
}

TEST(MipTexture, GivesTheTexelAtItsCentre) {
  const MipTexture texture = four_colors();
  EXPECT_EQ(texture.sample({0.25F, 0.25F}, 0.F), times_256(200, 0, 0));
  EXPECT_EQ(texture.sample({0.75F, 0.25F}, 0.F), times_256(0, 100, 0));
  EXPECT_EQ(texture.sample({0.25F, 0.75F}, -3.F), times_256(0, 0, 60));
  EXPECT_EQ(texture.sample({0.75F, 0.75F}, 0.F), times_256(240, 240, 240));
}

TEST(MipTexture, IsLinearBetweenTexels) {
  const MipTexture texture = four_colors();
  EXPECT_EQ(texture.sample({0.5F, 0.25F}, 0.F), times_256(100, 50, 0));
  EXPECT_EQ(texture.sample({0.5F, 0.5F}, 0.F), times_256(110, 85, 75));
}

TEST(MipTexture, GoesOnBeyondItsEdges) {
  const MipTexture texture = four_colors();
  EXPECT_EQ(texture.sample({-5.F, -5.F}, 0.F), times_256(200, 0, 0));
  EXPECT_EQ(texture.sample({9.F, 9.F}, 0.F), times_256(240, 240, 240));
}

TEST(MipTexture, StartsAgainWhereItRepeats) {
  const MipTexture texture = four_colors();
  EXPECT_EQ(texture.sample({1.25F, -1.75F}, 0.F, true), times_256(200, 0, 0));
  EXPECT_EQ(texture.sample({-0.25F, 7.25F}, 0.F, true), times_256(0, 100, 0));
  // Half way from the last column to the first.
  EXPECT_EQ(texture.sample({1.F, 0.25F}, 0.F, true), times_256(100, 50, 0));
  EXPECT_EQ(texture.sample({0.F, 0.25F}, 0.F, true), times_256(100, 50, 0));
}

TEST(MipTexture, AveragesAtCoarseLevels) {
  const MipTexture texture = four_colors();
  EXPECT_EQ(texture.sample({0.1F, 0.9F}, 1.F), times_256(110, 85, 75));
  EXPECT_EQ(texture.sample({0.1F, 0.9F}, 50.F), times_256(110, 85, 75));
  // Half way from the texel to the mean.
  EXPECT_EQ(texture.sample({0.25F, 0.25F}, 0.5F), (TexelSum{256 * 155, 128 * 85, 128 * 75}));
}

TEST(MipTexture, FourSamplesAreTheSumOfSingleOnes) {
  const MipTexture texture = four_colors();
  const std::array<TexturePoint, 4> at{{{0.3F, 0.3F}, {0.4F, 0.3F}, {0.3F, 0.4F}, {0.4F, 0.4F}}};
  for (const float level : {0.F, 0.4F, 1.F}) {
    const TexelSum four = texture.sample_four(at, level);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      std::uint32_t sum = 0;
      for (const TexturePoint& point : at) sum += texture.sample(point, level)[channel];
      EXPECT_NEAR(four[channel], sum, 8) << "level " << level;  // of 4 * 256 * 255
    }
  }
}

}  // namespace
}  // namespace stillmap
