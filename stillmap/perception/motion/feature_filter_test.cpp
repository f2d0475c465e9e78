// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/feature_filter.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/perception/motion/consecutive_matches.hpp"
#include "stillmap/slam/features/feature_selection.hpp"
#include "tests/support/feature_images.hpp"

namespace stillmap {
namespace {

constexpr int kRoomFeatures = 120;  // outside the box, all static
constexpr int kBoxFeatures = 40;    // inside: the first half moves, the other is static
const PixelBox kBox{400, 100, 560, 380};

/// Two frames of a synthetic room: a sliding camera, static points and moving points.
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
          {},
          std::make_shared<const Features>(two.previous),
          two.T_current_previous,
          FrameId(3)};
}

std::size_t count(const FilteredFeatures& filtered, FeatureVerdict verdict) {
  const auto dropped = std::ranges::count(filtered.dropped, verdict, &RejectedFeature::verdict);
  return static_cast<std::size_t>(std::ranges::count(filtered.verdicts, verdict) + dropped);
}

FeatureFilterConfig without_depth_stability() {
  FeatureFilterConfig config;
  config.depth_stability.enabled = false;
  return config;
}

TEST(MatchConsecutive, FindsEveryPointOnceWhetherItMovesOrNot) {
  const TwoFrames two = two_frames();
  const std::vector<FeatureMatch> matches = match_consecutive(two.previous,
                                                              two.current,
                                                              two.camera,
                                                              two.T_current_previous,
                                                              25,
                                                              StaticMatchesConfig{}.match);
  EXPECT_EQ(matches.size(), two.current.size());
  for (const FeatureMatch& match : matches) EXPECT_EQ(match.query, match.feature);
}

TEST(MatchConsecutive, SearchesNoFartherThanTold) {
  const TwoFrames two = two_frames();
  const std::vector<FeatureMatch> matches = match_consecutive(two.previous,
                                                              two.current,
                                                              two.camera,
                                                              two.T_current_previous,
                                                              2,
                                                              StaticMatchesConfig{}.match);
  // Static points are in place; the others move at least 0.05 m * 525 / 3.5 m = 7 pixels.
  EXPECT_EQ(matches.size(), static_cast<std::size_t>(kRoomFeatures + kBoxFeatures / 2));
}

TEST(FeatureFilter, PaperDropsWhatMovesInABoxAndNothingThatStands) {
  const TwoFrames two = two_frames();
  const FeatureFilter filter(without_depth_stability(), two.camera, dynamics_mode("paper"), 1);
  const FilteredFeatures filtered = filter.filter(scene_of(two));
  EXPECT_EQ(count(filtered, FeatureVerdict::kDynamic), static_cast<std::size_t>(kBoxFeatures / 2));
  EXPECT_EQ(filtered.dropped.size(), static_cast<std::size_t>(kBoxFeatures / 2));
  EXPECT_EQ(count(filtered, FeatureVerdict::kStaticInBox),
            static_cast<std::size_t>(kBoxFeatures / 2));
  EXPECT_EQ(count(filtered, FeatureVerdict::kStable), static_cast<std::size_t>(kRoomFeatures));
  EXPECT_EQ(filtered.features.size(), filtered.verdicts.size());
  // The moving features directly follow those of the room.
  for (const RejectedFeature& dropped : filtered.dropped) {
    const auto at = std::ranges::find(two.current.raw_px, dropped.raw_px);
    const auto index = at - two.current.raw_px.begin();
    EXPECT_GE(index, kRoomFeatures);
    EXPECT_LT(index, kRoomFeatures + kBoxFeatures / 2);
  }
}

TEST(FeatureFilter, WithoutStaticMatchesWhatMovesStays) {
  const TwoFrames two = two_frames();
  FeatureFilterConfig config = without_depth_stability();
  config.static_matches.enabled = false;
  const FilteredFeatures filtered =
      FeatureFilter(config, two.camera, dynamics_mode("paper"), 1).filter(scene_of(two));
  EXPECT_EQ(filtered.features.size(), two.current.size());
  EXPECT_TRUE(filtered.dropped.empty());
}

TEST(FeatureFilter, WhatHasNoMatchInTheFrameBeforeIsTreatedAsTold) {
  const TwoFrames two = two_frames();
  FeatureScene scene = scene_of(two);
  scene.previous = nullptr;
  FeatureFilterConfig config = without_depth_stability();
  config.static_matches.unmatched = "keep";
  const FeatureFilter keeping(config, two.camera, dynamics_mode("paper"), 1);
  EXPECT_EQ(keeping.filter(scene).features.size(), two.current.size());
  config.static_matches.unmatched = "drop";
  const FeatureFilter dropping(config, two.camera, dynamics_mode("paper"), 1);
  const FilteredFeatures dropped = dropping.filter(scene);
  EXPECT_EQ(dropped.features.size(), static_cast<std::size_t>(kRoomFeatures));
  EXPECT_EQ(dropped.judge, MatchJudge::kNothing);
}

TEST(FeatureFilter, WhatIsOnAMaskIsDroppedHoweverItMoves) {
  const TwoFrames two = two_frames();
  FeatureScene scene = scene_of(two);
  scene.masks = ObjectMask(cv::Mat1b(480, 640, std::uint8_t{0}));
  scene.masks.mat(cv::Rect(400, 100, 160, 280)).setTo(1);
  const FilteredFeatures filtered =
      FeatureFilter(without_depth_stability(), two.camera, dynamics_mode("paper"), 1).filter(scene);
  EXPECT_EQ(filtered.features.size(), static_cast<std::size_t>(kRoomFeatures));
}

// Fan 2020 has Eq. (14) before Eqs. (15)-(17): half of the room shifts by ten pixels, as at rims,
// where the depth is unstable. With these matches the matrix would be another.
TEST(FeatureFilter, TheMatrixComesFromMatchesOfStableDepth) {
  TwoFrames two = two_frames();
  TestDice dice(17);
  for (float& z : two.depth.mat) z += dice.uniform(-0.004F, 0.004F);
  for (std::size_t i = 0; i < 66; ++i) {
    const cv::Point pixel(cvRound(two.current.raw_px[i].x()), cvRound(two.current.raw_px[i].y()));
    two.depth.mat(pixel + cv::Point(1, 0)) = 4.0F;
    two.previous.raw_px[i].y() += 10.0F;
    two.previous.ideal_px[i].y() += 10.0F;
    two.previous.px[i].y() += 10.0F;
  }
  two.previous = gridded(two.previous, two.camera);
  FeatureFilterConfig config;
  config.static_matches.iterations = 5000;  // enough to find the majority
  const auto in_box = [&](const FilteredFeatures& filtered) {
    return count(filtered, FeatureVerdict::kStaticInBox);
  };
  const FilteredFeatures judged =
      FeatureFilter(config, two.camera, dynamics_mode("paper"), 1).filter(scene_of(two));
  EXPECT_EQ(judged.judge, MatchJudge::kFundamental);
  EXPECT_GE(in_box(judged), 18U);  // some are of unstable depth by chance
  ASSERT_TRUE(judged.matchable);
  EXPECT_EQ(judged.matchable->size(),
            two.current.size() - count(judged, FeatureVerdict::kUnstableDepth));
  config.depth_stability.enabled = false;
  EXPECT_LT(
      in_box(FeatureFilter(config, two.camera, dynamics_mode("paper"), 1).filter(scene_of(two))),
      10U);
}

/// Masks of two objects that share the box's features: the moving half is object 1, the other 2.
ObjectMask masks_of_two(const TwoFrames& two) {
  ObjectMask masks(cv::Mat1b(480, 640, std::uint8_t{0}));
  for (std::size_t i = 0; i < static_cast<std::size_t>(kBoxFeatures); ++i) {
    const Eigen::Vector2f& px = two.current.raw_px[kRoomFeatures + i];
    masks.mat(cv::Point(cvRound(px.x()), cvRound(px.y()))) = i < kBoxFeatures / 2 ? 1 : 2;
  }
  return masks;
}

// Yu 2018: the features of an object that moves are dropped, all of them, and no others.
TEST(FeatureFilter, DsSlamDropsTheFeaturesOfObjectsThatMove) {
  const TwoFrames two = two_frames();
  FeatureScene scene = scene_of(two);
  scene.masks = masks_of_two(two);
  const FeatureFilter filter({}, two.camera, dynamics_mode("ds-slam"), 1);
  const FilteredFeatures filtered = filter.filter(scene);
  EXPECT_EQ(filtered.judge, MatchJudge::kFundamental);
  EXPECT_EQ(filtered.dropped.size(), static_cast<std::size_t>(kBoxFeatures / 2));
  for (const RejectedFeature& dropped : filtered.dropped) {
    EXPECT_EQ(scene.masks.mat(cv::Point(cvRound(dropped.raw_px.x()), cvRound(dropped.raw_px.y()))),
              1);
  }
  // Without a frame before, all objects of dynamic classes count as moving.
  scene.previous = nullptr;
  EXPECT_EQ(filter.filter(scene).dropped.size(), static_cast<std::size_t>(kBoxFeatures));
}

TEST(FeatureFilter, FullJudgesBoxesOnlyWhenTold) {
  const TwoFrames two = two_frames();
  FeatureFilterConfig config = without_depth_stability();
  EXPECT_TRUE(FeatureFilter(config, two.camera, dynamics_mode("full"), 1)
                  .filter(scene_of(two))
                  .dropped.empty());
  config.static_matches.in_full = true;
  EXPECT_EQ(FeatureFilter(config, two.camera, dynamics_mode("full"), 1)
                .filter(scene_of(two))
                .dropped.size(),
            static_cast<std::size_t>(kBoxFeatures / 2));
}

// A depth step of 1 m beside one feature, and a hole beside another.
struct DepthFaults {
  TwoFrames two = two_frames();
  std::size_t jump = 5, hole = 9;

  DepthFaults() {
    // Stable depth varies slightly, as that of any sensor.
    TestDice dice(11);
    for (float& z : two.depth.mat) z += dice.uniform(-0.004F, 0.004F);
    const auto pixel = [&](std::size_t i) {
      return cv::Point(cvRound(two.current.raw_px[i].x()), cvRound(two.current.raw_px[i].y()));
    };
    two.depth.mat(pixel(jump) + cv::Point(1, 0)) = 3.0F;
    two.depth.mat(pixel(hole) + cv::Point(0, 1)) = 0.0F;
  }

  [[nodiscard]] FilteredFeatures filtered(const DynamicsMode& mode, bool in_full = false) const {
    FeatureFilterConfig config;
    config.depth_stability.in_full = in_full;
    return FeatureFilter(config, two.camera, mode, 1).filter(scene_of(two));
  }
  [[nodiscard]] std::size_t index_of(const FilteredFeatures& filtered, std::size_t i) const {
    const auto at = std::ranges::find(filtered.features.raw_px, two.current.raw_px[i]);
    return static_cast<std::size_t>(at - filtered.features.raw_px.begin());
  }
};

TEST(FeatureFilter, PaperDropsFeaturesOfUnstableAndOfMissingDepth) {
  const DepthFaults faults;
  const FilteredFeatures filtered = faults.filtered(dynamics_mode("paper"));
  EXPECT_EQ(faults.index_of(filtered, faults.jump), filtered.features.size());
  EXPECT_EQ(faults.index_of(filtered, faults.hole), filtered.features.size());
  EXPECT_EQ(count(filtered, FeatureVerdict::kMissingDepth), 1U);
  EXPECT_GE(count(filtered, FeatureVerdict::kUnstableDepth), 1U);
}

TEST(FeatureFilter, FullKeepsThemAndTrustsNoUnstableDepthWhenTold) {
  const DepthFaults faults;
  const FilteredFeatures filtered = faults.filtered(dynamics_mode("full"), true);
  ASSERT_EQ(filtered.features.size(), faults.two.current.size());
  EXPECT_EQ(filtered.features.depth_m[faults.jump], 0.0F);
  EXPECT_EQ(filtered.features.sensor_depth_m[faults.jump], 0.0F);
  EXPECT_EQ(filtered.features.depth_m[faults.hole], faults.two.current.depth_m[faults.hole]);
}

TEST(FeatureFilter, MaskAndFullJudgeNothing) {
  const DepthFaults faults;
  for (const char* const mode : {"mask", "full"}) {
    const FilteredFeatures filtered = faults.filtered(dynamics_mode(mode));
    EXPECT_EQ(count(filtered, FeatureVerdict::kStable), faults.two.current.size()) << mode;
    EXPECT_EQ(filtered.features.depth_m, faults.two.current.depth_m) << mode;
  }
}

TEST(FeatureFilter, TheSameSeedGivesTheSameBits) {
  const TwoFrames two = two_frames();
  const FeatureFilter filter({}, two.camera, dynamics_mode("paper"), 7);
  const FilteredFeatures a = filter.filter(scene_of(two)), b = filter.filter(scene_of(two));
  EXPECT_EQ(a.verdicts, b.verdicts);
  EXPECT_EQ(a.features.raw_px, b.features.raw_px);
}

}  // namespace
}  // namespace stillmap
