// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/inpainting.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

const cv::Rect kPerson(60, 30, 40, 60);

CameraModel small_camera() {
  CameraModel camera;
  camera.width_px = 160;
  camera.height_px = 120;
  camera.fx = camera.fy = 130;
  camera.cx = 80;
  camera.cy = 60;
  return camera;
}

/// A wall at z = 2 m in the world, whose colour grows with x and y, as a camera sees it.
RgbdFrame wall(const Eigen::Isometry3d& T_world_camera) {
  const CameraModel camera = small_camera();
  RgbdFrame frame;
  frame.color = ColorImage(cv::Mat3b(120, 160));
  frame.depth = DepthImage(cv::Mat1f(120, 160));
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const Eigen::Vector3d ray = T_world_camera.linear() * camera.unproject({u, v}, 1.0);
      const double z = (2.0 - T_world_camera.translation().z()) / ray.z();
      const Eigen::Vector3d p = T_world_camera.translation() + z * ray;
      frame.depth.mat(v, u) = static_cast<float>(z);
      frame.color.mat(v, u) = cv::Vec3b(cv::saturate_cast<std::uint8_t>(128 + 60 * p.x()),
                                        cv::saturate_cast<std::uint8_t>(128 + 60 * p.y()),
                                        200);
    }
  }
  return frame;
}

RgbdFrame with_person(RgbdFrame frame) {
  frame.color.mat(kPerson).setTo(cv::Vec3b(0, 255, 0));
  frame.depth.mat(kPerson).setTo(1.0F);
  return frame;
}

Mask person_mask() {
  cv::Mat1b mask(120, 160, std::uint8_t{0});
  mask(kPerson).setTo(255);
  return Mask(mask);
}

class Inpainting : public testing::Test {
 protected:
  const Eigen::Isometry3d before_ = Eigen::Isometry3d::Identity();
  const Eigen::Isometry3d now_ = make_pose(so3_exp({0.01, -0.02, 0.005}), {0.05, 0.02, -0.03});
  Inpainter inpainter_{small_camera()};
};

TEST_F(Inpainting, ShowsTheWallBehindThePerson) {
  inpainter_.add_keyframe(wall(before_), {}, before_);
  const InpaintedFrame painted = inpainter_.inpaint(with_person(wall(now_)), person_mask(), now_);
  EXPECT_GT(painted.filled_share, 0.9);
  const RgbdFrame truth = wall(now_);
  int filled = 0;
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const bool person = kPerson.contains({u, v});
      if (person && !painted.filled.covers(v, u)) {
        EXPECT_EQ(painted.depth.mat(v, u), 0.0F);
        EXPECT_EQ(painted.color.mat(v, u), cv::Vec3b(0, 0, 0));
        continue;
      }
      filled += person ? 1 : 0;
      EXPECT_NEAR(painted.depth.mat(v, u), truth.depth.mat(v, u), person ? 0.002 : 0.0);
      // Half a pixel of the wall is 8 mm, half a step of its colour.
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(painted.color.mat(v, u)[c], truth.color.mat(v, u)[c], person ? 2 : 0);
      }
    }
  }
  EXPECT_NEAR(painted.filled_share, static_cast<double>(filled) / kPerson.area(), 1e-9);
}

TEST_F(Inpainting, TakesNothingFromAPersonOfAKeyframe) {
  inpainter_.add_keyframe(with_person(wall(now_)), person_mask(), now_);
  const InpaintedFrame painted = inpainter_.inpaint(with_person(wall(now_)), person_mask(), now_);
  EXPECT_EQ(painted.filled_share, 0.0);
  EXPECT_EQ(cv::countNonZero(painted.depth.mat(kPerson)), 0);
}

TEST_F(Inpainting, TheNearestOfSeveralSurfacesCounts) {
  RgbdFrame nearer = wall(before_);
  nearer.depth.mat.setTo(1.5F);
  inpainter_.add_keyframe(wall(before_), {}, before_);
  inpainter_.add_keyframe(nearer, {}, before_);
  inpainter_.add_keyframe(wall(before_), {}, before_);
  const InpaintedFrame painted =
      inpainter_.inpaint(with_person(wall(before_)), person_mask(), before_);
  EXPECT_EQ(painted.filled_share, 1.0);
  EXPECT_NEAR(painted.depth.mat(60, 80), 1.5, 1e-6);
}

TEST_F(Inpainting, AFrameWithoutDynamicPixelsStaysAsItIs) {
  inpainter_.add_keyframe(with_person(wall(before_)), {}, before_);
  const RgbdFrame frame = wall(now_);
  const InpaintedFrame painted = inpainter_.inpaint(frame, {}, now_);
  EXPECT_EQ(cv::norm(painted.depth.mat, frame.depth.mat, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(painted.color.mat, frame.color.mat, cv::NORM_INF), 0);
  EXPECT_EQ(painted.filled_share, 1.0);
}

}  // namespace
}  // namespace stillmap
