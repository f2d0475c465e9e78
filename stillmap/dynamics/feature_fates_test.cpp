// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dynamics/feature_fates.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/core/se3.hpp"
#include "stillmap/dynamics/consecutive_matches.hpp"
#include "stillmap/features/feature_selection.hpp"
#include "stillmap/features/features_test_support.hpp"

namespace stillmap {
namespace {

constexpr int kRoomFeatures = 120;  // outside of the box, all standing
constexpr int kBoxFeatures = 40;    // inside: the first half moves, the other stands
const PixelBox kBox{400, 100, 560, 380};

/// Two frames of a made room: a camera that slides, points that stand and points that move.
struct TwoFrames {
  CameraModel camera = builtin_camera("tum_fr3");
  Eigen::Isometry3d T_current_previous =
      make_pose(so3_exp({0.004, -0.008, 0.002}), {0.03, 0.008, 0.004});
  Features previous, current;
  DepthImage depth{cv::Mat1f(480, 640, 2.0F)};
};

void add(Features& features,
         const Eigen::Vector2d& px,
         double depth_m,
         const Descriptor& descriptor) {
  features.raw_px.emplace_back(px.cast<float>());
  features.ideal_px.emplace_back(px.cast<float>());
  features.px.emplace_back(px.cast<float>());
  features.sensor_depth_m.push_back(static_cast<float>(depth_m));
  features.depth_m.push_back(static_cast<float>(depth_m));
  features.level.push_back(0);
  features.angle_deg.push_back(0);
  features.descriptors.push_back(descriptor);
}

Features gridded(const Features& features, const CameraModel& camera) {
  return select_features(features, std::vector<std::uint8_t>(features.size(), 1), camera);
}

TwoFrames two_frames() {
  TwoFrames two;
  TestDice dice(5);
  const auto see = [&](const Eigen::Vector2d& px, const Eigen::Vector3d& motion) {
    const double depth = 1.5 + static_cast<double>(dice.uniform(0, 2));
    const Eigen::Vector3d p = two.T_current_previous * (two.camera.unproject(px, depth) + motion);
    const Descriptor looks = dice.descriptor();
    add(two.previous, px, depth, looks);
    add(two.current, two.camera.project(p), p.z(), looks);
  };
  for (int i = 0; i < kRoomFeatures; ++i) {
    see(dice.point(40, 360, 440).cast<double>(), Eigen::Vector3d::Zero());
  }
  for (int i = 0; i < kBoxFeatures; ++i) {
    const bool moves = i < kBoxFeatures / 2;
    const Eigen::Vector2d px(static_cast<double>(dice.uniform(440, 540)),
                             static_cast<double>(dice.uniform(140, 340)));
    see(px, moves ? Eigen::Vector3d(0.0, 0.05, 0.0) : Eigen::Vector3d::Zero());
  }
  // The depth image is flat at 2 m except where a test changes it.
  two.previous = gridded(two.previous, two.camera);
  two.current = gridded(two.current, two.camera);
  return two;
}

FeatureScene scene_of(const TwoFrames& two) {
  return {two.current,
          two.depth,
          {kBox},
          std::make_shared<const Features>(two.previous),
          two.T_current_previous,
          FrameId(3)};
}

std::size_t count(const SiftedFeatures& sifted, FeatureFate fate) {
  const auto dropped = std::ranges::count(sifted.dropped, fate, &FatedFeature::fate);
  return static_cast<std::size_t>(std::ranges::count(sifted.fates, fate) + dropped);
}

FeatureFatesConfig without_depth_stability() {
  FeatureFatesConfig config;
  config.depth_stability.enabled = false;
  return config;
}

TEST(MatchConsecutive, FindsEveryPointOnceWhetherItMovesOrNot) {
  const TwoFrames two = two_frames();
  const std::vector<FeatureMatch> matches =
      match_consecutive(two.previous, two.current, two.camera, two.T_current_previous, 25);
  EXPECT_EQ(matches.size(), two.current.size());
  for (const FeatureMatch& match : matches) EXPECT_EQ(match.query, match.feature);
}

TEST(MatchConsecutive, SearchesNoFartherThanTold) {
  const TwoFrames two = two_frames();
  const std::vector<FeatureMatch> matches =
      match_consecutive(two.previous, two.current, two.camera, two.T_current_previous, 2);
  // What stands is where it should be; what moves goes at least 0.05 m * 525 / 3.5 m = 7 pixels.
  EXPECT_EQ(matches.size(), static_cast<std::size_t>(kRoomFeatures + kBoxFeatures / 2));
}

TEST(FeatureSifter, PaperDropsWhatMovesInABoxAndNothingThatStands) {
  const TwoFrames two = two_frames();
  const FeatureSifter sifter(without_depth_stability(), two.camera, DynamicsMode::kPaper, 1);
  const SiftedFeatures sifted = sifter.sift(scene_of(two));
  EXPECT_EQ(count(sifted, FeatureFate::kDynamic), static_cast<std::size_t>(kBoxFeatures / 2));
  EXPECT_EQ(sifted.dropped.size(), static_cast<std::size_t>(kBoxFeatures / 2));
  EXPECT_EQ(count(sifted, FeatureFate::kStaticInBox), static_cast<std::size_t>(kBoxFeatures / 2));
  EXPECT_EQ(count(sifted, FeatureFate::kStable), static_cast<std::size_t>(kRoomFeatures));
  EXPECT_EQ(sifted.features.size(), sifted.fates.size());
  // The moving ones are those just before the last of all features.
  for (const FatedFeature& dropped : sifted.dropped) {
    const auto at = std::ranges::find(two.current.raw_px, dropped.raw_px);
    const auto index = at - two.current.raw_px.begin();
    EXPECT_GE(index, kRoomFeatures);
    EXPECT_LT(index, kRoomFeatures + kBoxFeatures / 2);
  }
}

TEST(FeatureSifter, WithoutStaticMatchesWhatMovesStays) {
  const TwoFrames two = two_frames();
  FeatureFatesConfig config = without_depth_stability();
  config.static_matches.enabled = false;
  const SiftedFeatures sifted =
      FeatureSifter(config, two.camera, DynamicsMode::kPaper, 1).sift(scene_of(two));
  EXPECT_EQ(sifted.features.size(), two.current.size());
  EXPECT_TRUE(sifted.dropped.empty());
}

TEST(FeatureSifter, WhatHasNoMatchInTheFrameBeforeStays) {
  const TwoFrames two = two_frames();
  FeatureScene scene = scene_of(two);
  scene.previous = nullptr;
  const FeatureSifter sifter(without_depth_stability(), two.camera, DynamicsMode::kPaper, 1);
  EXPECT_EQ(sifter.sift(scene).features.size(), two.current.size());
}

TEST(FeatureSifter, FullJudgesBoxesOnlyWhenTold) {
  const TwoFrames two = two_frames();
  FeatureFatesConfig config = without_depth_stability();
  EXPECT_TRUE(FeatureSifter(config, two.camera, DynamicsMode::kFull, 1)
                  .sift(scene_of(two))
                  .dropped.empty());
  config.static_matches.in_full = true;
  EXPECT_EQ(
      FeatureSifter(config, two.camera, DynamicsMode::kFull, 1).sift(scene_of(two)).dropped.size(),
      static_cast<std::size_t>(kBoxFeatures / 2));
}

// A step of a metre through one feature's surroundings, and a hole in another's.
struct DepthFaults {
  TwoFrames two = two_frames();
  std::size_t jump = 5, hole = 9;

  DepthFaults() {
    // Steady depth varies a little, as any sensor's does.
    TestDice dice(11);
    for (float& z : two.depth.mat) z += dice.uniform(-0.004F, 0.004F);
    const auto pixel = [&](std::size_t i) {
      return cv::Point(cvRound(two.current.raw_px[i].x()), cvRound(two.current.raw_px[i].y()));
    };
    two.depth.mat(pixel(jump) + cv::Point(1, 0)) = 3.0F;
    two.depth.mat(pixel(hole) + cv::Point(0, 1)) = 0.0F;
  }

  [[nodiscard]] SiftedFeatures sifted(DynamicsMode mode) const {
    return FeatureSifter({}, two.camera, mode, 1).sift(scene_of(two));
  }
  [[nodiscard]] std::size_t index_of(const SiftedFeatures& sifted, std::size_t i) const {
    const auto at = std::ranges::find(sifted.features.raw_px, two.current.raw_px[i]);
    return static_cast<std::size_t>(at - sifted.features.raw_px.begin());
  }
};

TEST(FeatureSifter, PaperDropsFeaturesOfUnstableAndOfMissingDepth) {
  const DepthFaults faults;
  const SiftedFeatures sifted = faults.sifted(DynamicsMode::kPaper);
  EXPECT_EQ(faults.index_of(sifted, faults.jump), sifted.features.size());
  EXPECT_EQ(faults.index_of(sifted, faults.hole), sifted.features.size());
  EXPECT_EQ(count(sifted, FeatureFate::kMissingDepth), 1U);
  EXPECT_GE(count(sifted, FeatureFate::kUnstableDepth), 1U);
}

TEST(FeatureSifter, FullKeepsThemAndTrustsNoUnstableDepth) {
  const DepthFaults faults;
  const SiftedFeatures sifted = faults.sifted(DynamicsMode::kFull);
  ASSERT_EQ(sifted.features.size(), faults.two.current.size());
  EXPECT_EQ(sifted.features.depth_m[faults.jump], 0.0F);
  EXPECT_EQ(sifted.features.sensor_depth_m[faults.jump], 0.0F);
  EXPECT_EQ(sifted.features.depth_m[faults.hole], faults.two.current.depth_m[faults.hole]);
}

TEST(FeatureSifter, MaskJudgesNothing) {
  const DepthFaults faults;
  const SiftedFeatures sifted = faults.sifted(DynamicsMode::kMask);
  EXPECT_EQ(count(sifted, FeatureFate::kStable), faults.two.current.size());
  EXPECT_EQ(sifted.features.depth_m, faults.two.current.depth_m);
}

TEST(FeatureSifter, TheSameSeedGivesTheSameBits) {
  const TwoFrames two = two_frames();
  const FeatureSifter sifter({}, two.camera, DynamicsMode::kPaper, 7);
  const SiftedFeatures a = sifter.sift(scene_of(two)), b = sifter.sift(scene_of(two));
  EXPECT_EQ(a.fates, b.fates);
  EXPECT_EQ(a.features.raw_px, b.features.raw_px);
}

}  // namespace
}  // namespace stillmap
