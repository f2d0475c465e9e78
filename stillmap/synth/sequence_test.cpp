// SPDX-License-Identifier: Apache-2.0
#include "stillmap/synth/sequence.hpp"

#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>

namespace stillmap {
namespace {

SyntheticOptions small_options(PathKind path, std::uint32_t seed = 5) {
  SyntheticOptions options;
  options.path = path;
  options.camera = synthetic_camera(320, 240);
  options.frames = 600;
  options.seed = seed;
  options.sensor = SensorOptions::clean();
  return options;
}

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && a.isContinuous() && b.isContinuous() &&
         std::equal(a.datastart, a.dataend, b.datastart);
}

// Depth between pixels: inverse depth is linear over a plane. Nothing where the sixteen pixels
// around are not on one plane.
std::optional<double> depth_at(const cv::Mat1f& depth, const Eigen::Vector2d& pixel) {
  const int x = static_cast<int>(std::floor(pixel.x()));
  const int y = static_cast<int>(std::floor(pixel.y()));
  if (x < 1 || y < 1 || x + 2 >= depth.cols || y + 2 >= depth.rows) return std::nullopt;
  const double origin = 1.0 / depth(y, x);
  const double along_x = 1.0 / depth(y, x + 1) - origin, along_y = 1.0 / depth(y + 1, x) - origin;
  for (int row = -1; row <= 2; ++row) {
    for (int column = -1; column <= 2; ++column) {
      const double plane = origin + column * along_x + row * along_y;
      if (std::abs(1.0 / depth(y + row, x + column) - plane) > 2e-5) return std::nullopt;
    }
  }
  return 1.0 / (origin + (pixel.x() - x) * along_x + (pixel.y() - y) * along_y);
}

struct Agreement {
  int agree = 0;        // within 5 mm
  int occluded = 0;     // something nearer covers the point
  int see_through = 0;  // nothing where the point should be
};

Agreement reproject(const SyntheticSequence& sequence, FrameId from, FrameId to) {
  const FramePtr a = sequence.frame(from), b = sequence.frame(to);
  const Eigen::Isometry3d T_b_a = sequence.pose(to).inverse() * sequence.pose(from);
  const CameraModel& camera = sequence.camera();
  Agreement result;
  for (int y = 0; y < camera.height_px; y += 2) {
    for (int x = 0; x < camera.width_px; x += 2) {
      const Eigen::Vector2d raw(x, y);
      const Eigen::Vector3d p_a = camera.unproject(camera.undistort(raw), a->depth.mat(y, x));
      const Eigen::Vector3d p_b = T_b_a * p_a;
      if (p_b.z() < 0.1) continue;
      const std::optional<double> z = depth_at(b->depth.mat, camera.distort(camera.project(p_b)));
      if (!z) continue;
      result.agree += std::abs(*z - p_b.z()) < 0.005 ? 1 : 0;
      result.occluded += *z < p_b.z() - 0.005 ? 1 : 0;
      result.see_through += *z > p_b.z() + 0.005 ? 1 : 0;
    }
  }
  return result;
}

TEST(SyntheticSequence, PointsLandOnTheDepthOfOtherFrames) {
  for (const PathKind path :
       {PathKind::kXyz, PathKind::kRpy, PathKind::kHalfsphere, PathKind::kLoop}) {
    const SyntheticSequence sequence(small_options(path));
    const Agreement found = reproject(sequence, FrameId(30), FrameId(60));
    EXPECT_GT(found.agree, 8000);
    EXPECT_LT(found.occluded, found.agree / 8);
    EXPECT_EQ(found.see_through, 0);
  }
}

TEST(SyntheticSequence, PointsLandOnTheDepthOfADistortedCamera) {
  SyntheticOptions options = small_options(PathKind::kXyz);
  options.camera = builtin_camera("tum_fr1");
  const SyntheticSequence sequence(options);
  const Agreement found = reproject(sequence, FrameId(0), FrameId(45));
  EXPECT_GT(found.agree, 30000);
  EXPECT_LT(found.occluded, found.agree / 8);
  EXPECT_EQ(found.see_through, 0);
}

TEST(SyntheticSequence, ShowsEnoughCorners) {
  for (const PathKind path : {PathKind::kXyz,
                              PathKind::kRpy,
                              PathKind::kHalfsphere,
                              PathKind::kStatic,
                              PathKind::kLoop}) {
    const SyntheticSequence sequence(small_options(path));
    int frames = 0, rich = 0;
    for (std::uint32_t i = 0; i < sequence.size(); i += 40) {
      std::vector<cv::KeyPoint> corners;
      cv::FAST(sequence.frame(FrameId(i))->gray.mat, corners, 20);
      ++frames;
      rich += corners.size() >= 500 ? 1 : 0;
    }
    EXPECT_GE(10 * rich, 9 * frames) << static_cast<int>(path);
  }
}

TEST(SyntheticSequence, RepeatsItselfToTheByte) {
  SyntheticOptions options = small_options(PathKind::kXyz);
  options.sensor = SensorOptions{};
  const SyntheticSequence first(options), second(options);
  options.seed = 6;
  const SyntheticSequence other(options);
  const FramePtr a = first.frame(FrameId(17)), b = second.frame(FrameId(17));
  EXPECT_TRUE(same_bytes(a->color.mat, b->color.mat));
  EXPECT_TRUE(same_bytes(a->depth.mat, b->depth.mat));
  EXPECT_TRUE(same_bytes(a->gray.mat, first.frame(FrameId(17))->gray.mat));
  EXPECT_FALSE(same_bytes(a->color.mat, other.frame(FrameId(17))->color.mat));
  EXPECT_FALSE(same_bytes(a->depth.mat, other.frame(FrameId(17))->depth.mat));
}

TEST(SyntheticSequence, HasStampsOfItsRate) {
  const SyntheticSequence sequence(small_options(PathKind::kStatic));
  EXPECT_EQ(sequence.stamp(FrameId(0)).text, "1000.000000");
  EXPECT_EQ(sequence.stamp(FrameId(31)).text, "1001.033333");
  EXPECT_EQ(sequence.stamp(FrameId(31)).seconds, 1001.033333);
  const Trajectory truth = sequence.ground_truth();
  ASSERT_EQ(truth.size(), sequence.size());
  EXPECT_EQ(truth[31].stamp.text, "1001.033333");
  const Eigen::Isometry3d expected = T_world_camera(PathKind::kStatic, 31.0 / 30.0);
  EXPECT_TRUE(truth[31].T_world_camera.isApprox(expected, 1e-12));
  EXPECT_EQ(sequence.frame(FrameId(31))->depth_stamp_s, 1001.033333);
}

TEST(SyntheticCamera, KeepsTheFieldOfViewOfTheOriginal) {
  const CameraModel original = builtin_camera("tum_fr3");
  const CameraModel same = synthetic_camera(640, 480);
  EXPECT_DOUBLE_EQ(same.fx, original.fx);
  EXPECT_DOUBLE_EQ(same.cx, original.cx);
  EXPECT_DOUBLE_EQ(same.cy, original.cy);
  const CameraModel half = synthetic_camera(320, 240);
  EXPECT_DOUBLE_EQ(half.fy, 0.5 * original.fy);
  // The outer border of the image, half a pixel beyond the first centre, stays where it was.
  EXPECT_NEAR((-0.5 - half.cx) / half.fx, (-0.5 - original.cx) / original.fx, 1e-12);
  EXPECT_NEAR((-0.5 - half.cy) / half.fy, (-0.5 - original.cy) / original.fy, 1e-12);
}

}  // namespace
}  // namespace stillmap
