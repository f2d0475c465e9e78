// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/static_map.hpp"

#include <gtest/gtest.h>

#include "stillmap/geometry/camera.hpp"

namespace stillmap {
namespace {

TEST(CloudConfig, TheModeDecidesWhatIsLeftToIt) {
  const CloudConfig config;
  for (const char* mode : {"off", "mask"}) {
    EXPECT_EQ(config.resolved_for(dynamics_mode(mode).cloud).depth.edges, "off");
    EXPECT_EQ(config.resolved_for(dynamics_mode(mode).cloud).depth.islands, "off");
    EXPECT_EQ(config.resolved_for(dynamics_mode(mode).cloud).free_space, "off");
  }
  EXPECT_EQ(config.resolved_for(dynamics_mode("paper").cloud).depth.edges, "fixed");
  EXPECT_EQ(config.resolved_for(dynamics_mode("paper").cloud).depth.islands, "on");
  EXPECT_EQ(config.resolved_for(dynamics_mode("paper").cloud).free_space, "off");
  EXPECT_EQ(config.resolved_for(dynamics_mode("full").cloud).depth.edges, "growing");
  EXPECT_EQ(config.resolved_for(dynamics_mode("full").cloud).depth.islands, "off");
  EXPECT_EQ(config.resolved_for(dynamics_mode("full").cloud).free_space, "on");

  for (const char* mode : {"off", "mask", "full"}) {
    const CloudConfig resolved = config.resolved_for(dynamics_mode(mode).cloud);
    EXPECT_EQ(resolved.view_gap_frames, config.view_gap_frames);
    EXPECT_EQ(resolved.views.enough, config.views.enough);
    EXPECT_EQ(resolved.local.cells_across, config.local.cells_across);
  }
  // Fan 2020, Eq. (1): the views are the key frames, all of them, and each pixel is a point.
  const CloudConfig paper = config.resolved_for(dynamics_mode("paper").cloud);
  EXPECT_EQ(paper.view_gap_frames, 0);
  EXPECT_EQ(paper.views.enough, 0);
  EXPECT_GE(paper.local.cells_across, 10000);

  CloudConfig own;
  own.view_frames = "all";
  own.points = "cells";
  EXPECT_EQ(own.resolved_for(dynamics_mode("paper").cloud).view_gap_frames, own.view_gap_frames);
  EXPECT_EQ(own.resolved_for(dynamics_mode("paper").cloud).local.cells_across,
            own.local.cells_across);
  own.depth.edges = "off";
  own.depth.islands = "on";
  own.free_space = "on";
  EXPECT_EQ(own.resolved_for(dynamics_mode("full").cloud).depth.edges, "off");
  EXPECT_EQ(own.resolved_for(dynamics_mode("full").cloud).depth.islands, "on");
  EXPECT_EQ(own.resolved_for(dynamics_mode("paper").cloud).free_space, "on");
}

/// A wall at 3 m, with somebody before it at 1.5 m or not.
RgbdFrame wall(const CameraModel& camera, bool somebody) {
  RgbdFrame frame;
  frame.depth = DepthImage(cv::Mat1f(camera.height_px, camera.width_px, 3.0F));
  frame.color = ColorImage(cv::Mat3b(camera.height_px, camera.width_px, cv::Vec3b(9, 9, 9)));
  if (somebody) frame.depth.mat(cv::Rect(200, 100, 80, 200)).setTo(1.5F);
  return frame;
}

std::size_t near_points(const PointCloud& map) {
  std::size_t count = 0;
  for (const Eigen::Vector3f& p : map.positions) count += p.z() < 2 ? 1 : 0;
  return count;
}

std::size_t near_points(const CompactCloud& view) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < view.size(); ++i) count += view.position(i).z() < 2 ? 1 : 0;
  return count;
}

TEST(CloudStage, OnlyFullRemovesWhatLaterViewsSeeThrough) {
  const CameraModel camera = builtin_camera("tum_fr3");
  const cv::Mat2f rays = pixel_rays(camera);
  for (const char* mode : {"off", "mask", "paper", "full"}) {
    const CloudConfig config = CloudConfig{}.resolved_for(dynamics_mode(mode).cloud);
    std::vector<StaticView> views;
    for (int i = 0; i < 4; ++i) {
      views.push_back(static_view(wall(camera, i < 2), rays, config, {}, {}));
    }
    std::vector<PosedView> posed;
    for (const StaticView& view : views) posed.push_back({Eigen::Isometry3d::Identity(), &view});
    const PointCloud map = static_map(posed, camera, config);
    if (config.free_space == "on") {
      EXPECT_EQ(near_points(map), 0U);
    } else {
      EXPECT_GT(near_points(map), 500U) << mode;
    }
    EXPECT_GT(map.size(), 10000U);
  }
}

TEST(CloudStage, AViewLeavesOutWhatIsExcluded) {
  const CameraModel camera = builtin_camera("tum_fr3");
  cv::Mat1b somebody(480, 640, std::uint8_t{0});
  somebody(cv::Rect(195, 95, 90, 210)).setTo(1);
  const CloudConfig config = CloudConfig{}.resolved_for(dynamics_mode("full").cloud);
  const StaticView view = static_view(
      wall(camera, true), pixel_rays(camera), config, {Mask(somebody), Mask(somebody)}, {});
  EXPECT_EQ(near_points(view.cloud), 0U);
  EXPECT_TRUE(view.range.at(100, 120).moving());  // half the resolution: row 200, column 240
  EXPECT_NEAR(view.range.at(100, 120).range_m(), 1.5F, 0.002F);
  EXPECT_FALSE(view.range.at(10, 10).moving());
  // What a view keeps is small.
  EXPECT_LT(10 * view.cloud.size() + 2 * view.range.cells.size(), 360000U);
}

TEST(CloudStage, WhatRestsDoesNotMove) {
  FrameDynamics dynamics;
  dynamics.judged.mask.extended = ObjectMask(cv::Mat1b(480, 640, std::uint8_t{0}));
  dynamics.judged.mask.jumps = JumpImage(cv::Mat1b(480, 640, std::uint8_t{0}));
  dynamics.judged.mask.extended.mat(cv::Rect(10, 10, 50, 50)).setTo(1);
  dynamics.judged.mask.extended.mat(cv::Rect(100, 10, 50, 50)).setTo(2);
  dynamics.judged.mask.resting[2] = true;
  dynamics.excluded = dynamics.judged.mask.moving();
  const DynamicRegions masks = dynamic_regions(dynamics.judged.mask, dynamics.excluded);
  EXPECT_TRUE(masks.moving.covers(30, 30) && masks.excluded.covers(30, 30));
  EXPECT_FALSE(masks.moving.covers(30, 120) || masks.excluded.covers(30, 120));
}

TEST(CloudStage, SmallJumpsAreUnclearLargeOnesMove) {
  FrameDynamics dynamics;
  dynamics.judged.mask.extended = ObjectMask(cv::Mat1b(480, 640, std::uint8_t{0}));
  dynamics.judged.mask.jumps = JumpImage(cv::Mat1b(480, 640, std::uint8_t{0}));
  dynamics.judged.mask.extended.mat(cv::Rect(10, 10, 5, 5)).setTo(2);
  dynamics.judged.mask.jumps.mat(cv::Rect(100, 100, 8, 30)).setTo(1);
  dynamics.judged.mask.jumps.mat(cv::Rect(200, 100, 9, 30)).setTo(1);
  dynamics.excluded = dynamics.judged.mask.all();
  const DynamicRegions masks = dynamic_regions(dynamics.judged.mask, dynamics.excluded);
  EXPECT_NE(masks.moving.mat(12, 12), 0);
  EXPECT_EQ(masks.moving.mat(110, 104), 0);
  EXPECT_NE(masks.moving.mat(110, 204), 0);
  EXPECT_NE(masks.excluded.mat(110, 104), 0);
  EXPECT_TRUE(dynamic_regions({}, {}).moving.empty());
}

}  // namespace
}  // namespace stillmap
