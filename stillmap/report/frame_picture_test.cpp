// SPDX-License-Identifier: Apache-2.0
#include "stillmap/report/frame_picture.hpp"

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

TEST(DrawFeatures, rings_in_their_colours_on_a_copy) {
  SampleFrame frame = gray_frame(100, 80);
  frame.tracked_px = {{30, 40}};
  frame.untracked_px = {{70, 20}};
  const ColorImage drawn = draw_features(frame, 640);
  EXPECT_EQ(drawn.mat.size(), cv::Size(100, 80));
  EXPECT_TRUE(greenish(drawn.mat(40, 33)));
  EXPECT_TRUE(greenish(drawn.mat(37, 30)));
  EXPECT_EQ(drawn.mat(40, 30), cv::Vec3b(60, 60, 60));  // the ring's middle stays visible
  EXPECT_GT(drawn.mat(20, 72)[0], 120);
  EXPECT_FALSE(greenish(drawn.mat(20, 72)));
  EXPECT_EQ(frame.image.mat(40, 33), cv::Vec3b(60, 60, 60));
}

TEST(DrawFeatures, wide_images_become_smaller_and_features_move_along) {
  SampleFrame frame = gray_frame(400, 200);
  frame.tracked_px = {{200, 100}};
  const ColorImage drawn = draw_features(frame, 100);
  EXPECT_EQ(drawn.mat.size(), cv::Size(100, 50));
  EXPECT_TRUE(greenish(drawn.mat(25, 53)));
}

TEST(DrawFeatures, hostile_places_and_empty_images) {
  SampleFrame frame = gray_frame(50, 50);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  frame.tracked_px = {{kNan, 3}, {1e30F, 3}, {-1, 3}, {3, 50}};
  const ColorImage drawn = draw_features(frame, 640);
  for (const cv::Vec3b& c : drawn.mat) EXPECT_EQ(c, cv::Vec3b(60, 60, 60));
  EXPECT_TRUE(draw_features(SampleFrame{}, 640).mat.empty());
}

}  // namespace
}  // namespace stillmap
