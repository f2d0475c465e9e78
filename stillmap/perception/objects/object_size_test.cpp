// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/object_size.hpp"

#include <gtest/gtest.h>

namespace stillmap {
namespace {

// A board of 0.8 m by 1.5 m, facing the camera at 2.5 m, covers f * size / z pixels.
TEST(ObjectSize, OfABoardIsWidthTimesHeight) {
  CameraModel camera;
  camera.fx = 500;
  camera.fy = 400;
  const DepthImage depth(cv::Mat1f(480, 640, 2.5F));
  const PixelPatch board{cv::Rect(100, 50, 160, 240), cv::Mat1b(240, 160, std::uint8_t{1})};
  EXPECT_NEAR(silhouette_m2(board, depth, camera), 0.8 * 1.5, 1e-3);
}

TEST(ObjectSize, TakesPixelsWithoutDepthAsTheOthers) {
  CameraModel camera;
  camera.fx = camera.fy = 500;
  DepthImage depth(cv::Mat1f(480, 640, 2.0F));
  const PixelPatch board{cv::Rect(0, 0, 100, 100), cv::Mat1b(100, 100, std::uint8_t{1})};
  depth.mat(cv::Rect(0, 0, 50, 100)).setTo(0);
  EXPECT_NEAR(silhouette_m2(board, depth, camera), 0.4 * 0.4, 1e-3);
  depth.mat.setTo(0);
  EXPECT_EQ(silhouette_m2(board, depth, camera), 0);
}

TEST(ObjectSize, EveryClassHasABound) {
  EXPECT_GT(largest_silhouette_m2("person"), 2.0 * 0.6);
  EXPECT_LT(largest_silhouette_m2("person"), 2.0 * 2.0);
  EXPECT_GT(largest_silhouette_m2("bed"), largest_silhouette_m2("chair"));
  EXPECT_GT(largest_silhouette_m2("no such class"), 0);
}

}  // namespace
}  // namespace stillmap
