// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/frame_picture.hpp"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

SampleFrame gray_frame(int width, int height) {
  SampleFrame frame;
  frame.image = ColorImage(cv::Mat3b(height, width, cv::Vec3b(60, 60, 60)));
  return frame;
}

bool greenish(const cv::Vec3b& c) {
  return c[1] > 150 && c[1] > c[0] + 60 && c[1] > c[2] + 60;
}

TEST(DrawFrame, RingsInTheirColoursOnACopy) {
  SampleFrame frame = gray_frame(100, 80);
  frame.features = {{{30, 40}, SampleVerdict::kTracked}, {{70, 20}, SampleVerdict::kUntracked}};
  const ColorImage drawn = draw_frame(frame, 640);
  EXPECT_EQ(drawn.mat.size(), cv::Size(100, 80));
  EXPECT_TRUE(greenish(drawn.mat(40, 33)));
  EXPECT_TRUE(greenish(drawn.mat(37, 30)));
  EXPECT_EQ(drawn.mat(40, 30), cv::Vec3b(60, 60, 60));  // the ring's middle stays visible
  EXPECT_GT(drawn.mat(20, 72)[0], 120);
  EXPECT_FALSE(greenish(drawn.mat(20, 72)));
  EXPECT_EQ(frame.image.mat(40, 33), cv::Vec3b(60, 60, 60));
}

TEST(DrawFrame, WideImagesBecomeSmallerAndFeaturesMoveAlong) {
  SampleFrame frame = gray_frame(400, 200);
  frame.features = {{{200, 100}, SampleVerdict::kTracked}};
  const ColorImage drawn = draw_frame(frame, 100);
  EXPECT_EQ(drawn.mat.size(), cv::Size(100, 50));
  EXPECT_TRUE(greenish(drawn.mat(25, 53)));
}

TEST(DrawFrame, MasksAreOutlinedAndTinted) {
  SampleFrame frame = gray_frame(100, 80);
  const auto mask_of = [](const cv::Rect& area) {
    cv::Mat1b mask(80, 100, std::uint8_t{0});
    mask(area).setTo(3);
    return mask;
  };
  frame.extended_mask = mask_of({10, 10, 40, 40});
  frame.raw_mask = mask_of({20, 20, 20, 20});
  frame.jumps = mask_of({70, 10, 10, 10});
  const cv::Mat3b drawn = draw_frame(frame, 640).mat;
  const cv::Vec3b extended = drawn(12, 12), inside_raw = drawn(30, 30), jump = drawn(15, 75);
  EXPECT_GT(extended[0], extended[1] + 50);  // red
  EXPECT_EQ(inside_raw, extended);           // the network's mask is a line only
  EXPECT_GT(jump[0], 130);                   // yellow
  EXPECT_GT(jump[1], 110);
  EXPECT_LT(jump[2], 60);
  EXPECT_GT(drawn(20, 30)[1], 200);  // white
  EXPECT_EQ(drawn(60, 60), cv::Vec3b(60, 60, 60));
}

TEST(DrawFrame, MasksBecomeSmallerWithTheImage) {
  SampleFrame frame = gray_frame(400, 200);
  frame.jumps = cv::Mat1b(200, 400, std::uint8_t{0});
  frame.jumps(cv::Rect(0, 0, 200, 200)).setTo(1);
  const cv::Mat3b drawn = draw_frame(frame, 100).mat;
  EXPECT_GT(drawn(25, 48)[0], 130);
  EXPECT_EQ(drawn(25, 52), cv::Vec3b(60, 60, 60));
}

TEST(VerdictStyles, HasEachFateOnce) {
  for (const SampleVerdict verdict : {SampleVerdict::kUntracked, SampleVerdict::kTracked}) {
    EXPECT_EQ(std::ranges::count(verdict_styles(), verdict, &VerdictStyle::verdict), 1);
  }
}

TEST(DrawFrame, HostilePlacesAndEmptyImages) {
  SampleFrame frame = gray_frame(50, 50);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (const Eigen::Vector2f& at : {Eigen::Vector2f(kNan, 3), {1e30F, 3}, {-1, 3}, {3, 50}}) {
    frame.features.push_back({at, SampleVerdict::kTracked});
  }
  frame.raw_mask = cv::Mat1b(10, 10, std::uint8_t{1});
  frame.jumps = cv::Mat1b(60, 50, std::uint8_t{1});
  const ColorImage drawn = draw_frame(frame, 640);
  for (const cv::Vec3b& c : drawn.mat) EXPECT_EQ(c, cv::Vec3b(60, 60, 60));
  EXPECT_TRUE(draw_frame(SampleFrame{}, 640).mat.empty());
}

}  // namespace
}  // namespace stillmap
