// SPDX-License-Identifier: Apache-2.0
#include "tooling/view/frame_sample.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

constexpr int kWidth = 64, kHeight = 48;

CameraModel small_camera() {
  CameraModel camera;
  camera.width_px = kWidth;
  camera.height_px = kHeight;
  camera.fx = camera.fy = 50;
  camera.cx = 32;
  camera.cy = 24;
  return camera;
}

// A wall at 2 m, all of one colour, seen from the origin.
ViewedSample wall() {
  RgbdFrame frame = make_frame(1.0,
                               ColorImage(cv::Mat3b(kHeight, kWidth, cv::Vec3b(10, 20, 30))),
                               DepthImage(cv::Mat1f(kHeight, kWidth, 2.0F)));
  frame.id = FrameId(4);
  FrameResult result;
  result.id = frame.id;
  result.status = TrackingStatus::kTracked;
  return {std::move(frame), std::move(result)};
}

TEST(PixelGrid, HasTheRaysOfItsPixels) {
  const PixelGrid grid(small_camera(), 16);
  EXPECT_EQ(grid.step(), 4);
  EXPECT_EQ(grid.pixels().size(), 16U * 12U);
  for (const PixelGrid::Pixel& pixel : grid.pixels()) {
    EXPECT_FLOAT_EQ(pixel.x, static_cast<float>(pixel.column - 32) / 50);
    EXPECT_FLOAT_EQ(pixel.y, static_cast<float>(pixel.row - 24) / 50);
  }
}

TEST(GrowingMap, TakesTheWallOnceWhereItIs) {
  GrowingMap map(small_camera());
  ViewedSample sample = wall();
  sample.second.T_world_camera.translation() = Eigen::Vector3d(5, 0, 0);
  const PointCloud first = map.add(sample);
  ASSERT_GT(first.size(), 1000U);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_FLOAT_EQ(first.positions[i].z(), 2.0F);
    EXPECT_NEAR(first.positions[i].x(), 5.0F, 32 / 50.0 * 2 + 1e-3);
    EXPECT_EQ(first.colors[i], (Rgb{10, 20, 30}));
  }
  EXPECT_TRUE(map.add(sample).empty());  // all of it is known
}

TEST(GrowingMap, LeavesOutWhatMovesAndWhatHasNoPose) {
  GrowingMap map(small_camera());
  ViewedSample sample = wall();
  sample.second.excluded = Mask(cv::Mat1b::zeros(kHeight, kWidth));
  sample.second.excluded.mat(cv::Rect(0, 0, kWidth / 2, kHeight)) = 1;
  for (const Eigen::Vector3f& p : map.add(sample).positions) EXPECT_GE(p.x(), 0);
  sample.second.status = TrackingStatus::kLost;
  sample.second.excluded = {};
  EXPECT_TRUE(map.add(sample).empty());
}

TEST(GhostPoints, AreThoseOfDynamicObjects) {
  ViewedSample sample = wall();
  sample.second.objects.resize(2);
  sample.second.objects[1].dynamic = true;
  cv::Mat1b ids = cv::Mat1b::zeros(kHeight, kWidth);
  ids(cv::Rect(0, 0, 8, 8)) = 1;    // static
  ids(cv::Rect(40, 8, 8, 12)) = 2;  // dynamic
  sample.second.object_mask = ObjectMask(ids);
  const GhostPoints ghosts = ghost_points(sample, PixelGrid(small_camera(), kWidth));
  ASSERT_EQ(ghosts.size(), 8U * 12U);
  for (std::size_t i = 0; i < ghosts.size(); ++i) {
    EXPECT_EQ(ghosts.positions[3 * i + 2], 32768 + 2000);
    EXPECT_GE(ghosts.positions[3 * i], 32768 + (40 - 32) * 2000 / 50);
    EXPECT_EQ(ghosts.colors[4 * i + 3], 1);
  }
}

TEST(MaskRuns, CountEveryPixelWithItsMasks) {
  ViewedSample sample = wall();
  EXPECT_EQ(mask_runs(sample, kWidth).width_px, 0);
  cv::Mat1b network = cv::Mat1b::zeros(kHeight, kWidth), extended = network.clone();
  network(cv::Rect(10, 10, 5, 3)) = 1;
  extended(cv::Rect(8, 10, 9, 3)) = 1;
  sample.second.network_mask = ObjectMask(network);
  sample.second.extended_mask = ObjectMask(extended);
  sample.second.depth_jumps = Mask(cv::Mat1b::ones(7, 7));  // of another size
  const MaskRuns masks = mask_runs(sample, kWidth);
  EXPECT_EQ(masks.width_px, kWidth);
  EXPECT_EQ(masks.height_px, kHeight);
  std::vector<int> counts(8, 0);
  int at = 0;
  for (std::size_t i = 0; i < masks.runs.size(); i += 2) {
    for (int k = 0; k < masks.runs[i + 1]; ++k, ++at) {
      const int expected = (network(at / kWidth, at % kWidth) != 0 ? 1 : 0) +
                           (extended(at / kWidth, at % kWidth) != 0 ? 2 : 0);
      EXPECT_EQ(masks.runs[i], expected) << at;
    }
  }
  EXPECT_EQ(at, kWidth * kHeight);
}

TEST(FeatureMarks, AreQuartersOfAPixelAndAStyle) {
  ViewedSample sample = wall();
  sample.second.features = {{{10.5F, 3.25F}, FeatureVerdict::kStable, true},
                            {{-1, 3}, FeatureVerdict::kStable, true},
                            {{2, 1000}, FeatureVerdict::kStable, true}};
  const std::vector<std::uint16_t> marks = feature_marks(sample);
  ASSERT_EQ(marks.size(), 3U);
  EXPECT_EQ(marks[0], 42);
  EXPECT_EQ(marks[1], 13);
}

TEST(PictureJpeg, IsReducedAndEmptyForNoImage) {
  EXPECT_TRUE(picture_jpeg({}, 100).empty());
  const std::vector<std::uint8_t> jpeg = picture_jpeg(wall().first.color, 32);
  ASSERT_GT(jpeg.size(), 100U);
  EXPECT_EQ(jpeg[0], 0xff);
  EXPECT_EQ(jpeg[1], 0xd8);
}

}  // namespace
}  // namespace stillmap
