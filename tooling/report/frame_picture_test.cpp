// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/frame_picture.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

ReportSample gray_frame(int width, int height) {
  ReportSample sample;
  sample.first.color = ColorImage(cv::Mat3b(height, width, cv::Vec3b(60, 60, 60)));
  return sample;
}

FeatureMark tracked_at(float x, float y) {
  return {{x, y}, FeatureVerdict::kStable, true};
}

bool greenish(const cv::Vec3b& c) {
  return c[1] > 150 && c[1] > c[0] + 60 && c[1] > c[2] + 60;
}

TEST(DrawFrame, RingsInTheirColoursOnACopy) {
  ReportSample frame = gray_frame(100, 80);
  frame.second.features = {tracked_at(30, 40), {{70, 20}, FeatureVerdict::kStable, false}};
  const ColorImage drawn = draw_frame(frame, 640);
  EXPECT_EQ(drawn.mat.size(), cv::Size(100, 80));
  EXPECT_TRUE(greenish(drawn.mat(40, 33)));
  EXPECT_TRUE(greenish(drawn.mat(37, 30)));
  EXPECT_EQ(drawn.mat(40, 30), cv::Vec3b(60, 60, 60));  // the ring's middle stays visible
  EXPECT_GT(drawn.mat(20, 72)[0], 120);
  EXPECT_FALSE(greenish(drawn.mat(20, 72)));
  EXPECT_EQ(frame.first.color.mat(40, 33), cv::Vec3b(60, 60, 60));
}

TEST(DrawFrame, WideImagesBecomeSmallerAndFeaturesMoveAlong) {
  ReportSample frame = gray_frame(400, 200);
  frame.second.features = {tracked_at(200, 100)};
  const ColorImage drawn = draw_frame(frame, 100);
  EXPECT_EQ(drawn.mat.size(), cv::Size(100, 50));
  EXPECT_TRUE(greenish(drawn.mat(25, 53)));
}

TEST(DrawFrame, MasksAreOutlinedAndTinted) {
  ReportSample frame = gray_frame(100, 80);
  const auto mask_of = [](const cv::Rect& area) {
    cv::Mat1b mask(80, 100, std::uint8_t{0});
    mask(area).setTo(3);
    return mask;
  };
  frame.second.extended_mask.mat = mask_of({10, 10, 40, 40});
  frame.second.network_mask.mat = mask_of({20, 20, 20, 20});
  frame.second.depth_jumps.mat = mask_of({70, 10, 10, 10});
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
  ReportSample frame = gray_frame(400, 200);
  frame.second.depth_jumps.mat = cv::Mat1b(200, 400, std::uint8_t{0});
  frame.second.depth_jumps.mat(cv::Rect(0, 0, 200, 200)).setTo(1);
  const cv::Mat3b drawn = draw_frame(frame, 100).mat;
  EXPECT_GT(drawn(25, 48)[0], 130);
  EXPECT_EQ(drawn(25, 52), cv::Vec3b(60, 60, 60));
}

TEST(VerdictStyles, TellEveryVerdictApart) {
  const auto name = [](FeatureVerdict verdict, bool tracked) {
    return std::string(style_of({{1, 1}, verdict, tracked}).name);
  };
  EXPECT_EQ(name(FeatureVerdict::kStable, true), "tracked");
  EXPECT_EQ(name(FeatureVerdict::kStable, false), "found but not tracked");
  for (const bool tracked : {false, true}) {
    EXPECT_EQ(name(FeatureVerdict::kMissingDepth, tracked), "with depth missing");
    EXPECT_EQ(name(FeatureVerdict::kUnstableDepth, tracked), "at a jump of depth");
    EXPECT_EQ(name(FeatureVerdict::kDynamic, tracked), "dynamic");
    EXPECT_EQ(name(FeatureVerdict::kStaticInBox, tracked),
              "static in the box of something dynamic");
  }
}

TEST(DrawFrame, HostilePlacesAndEmptyImages) {
  ReportSample frame = gray_frame(50, 50);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  frame.second.features = {
      tracked_at(kNan, 3), tracked_at(1e30F, 3), tracked_at(-1, 3), tracked_at(3, 50)};
  frame.second.network_mask.mat = cv::Mat1b(10, 10, std::uint8_t{1});
  frame.second.depth_jumps.mat = cv::Mat1b(60, 50, std::uint8_t{1});
  const ColorImage drawn = draw_frame(frame, 640);
  for (const cv::Vec3b& c : drawn.mat) EXPECT_EQ(c, cv::Vec3b(60, 60, 60));
  EXPECT_TRUE(draw_frame(ReportSample{}, 640).mat.empty());
}

}  // namespace
}  // namespace stillmap
