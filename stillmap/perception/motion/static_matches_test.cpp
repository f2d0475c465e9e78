// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/static_matches.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/core/random.hpp"
#include "stillmap/geometry/epipolar.hpp"
#include "stillmap/geometry/ray_rotation.hpp"
#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

/// A synthetic room: points 1.5 to 4 m before a camera with a known motion.
class TwoViews {
 public:
  explicit TwoViews(const Eigen::Isometry3d& T_current_previous, double noise_px = 0.2)
      : T_(T_current_previous), noise_px_(noise_px) {}

  [[nodiscard]] double between(double low, double high) {
    return low + (high - low) * static_cast<double>(rng_()) / 4294967295.0;
  }

  /// A point seen at `px` and `depth` in the first view that moves by `motion` in that view's axes.
  [[nodiscard]] PointMatch match(const Eigen::Vector2d& px,
                                 double depth,
                                 const Eigen::Vector3d& motion = Eigen::Vector3d::Zero()) {
    const Eigen::Vector3d p = T_ * (camera.unproject(px, depth) + motion);
    const Eigen::Vector2d noise(between(-1, 1), between(-1, 1));
    return {px, camera.project(p) + noise_px_ * noise, depth, p.z()};
  }

  [[nodiscard]] PointMatch standing() {
    return match({between(20, 620), between(20, 460)}, between(1.5, 4.0));
  }

  [[nodiscard]] std::vector<PointMatch> room(int points, int wrong = 0) {
    std::vector<PointMatch> matches;
    for (int i = 0; i < points; ++i) {
      matches.push_back(standing());
      if (i >= wrong) continue;
      matches.back().current_px = {between(20, 620), between(20, 460)};
    }
    return matches;
  }

  [[nodiscard]] MatchVerdict judge(const TwoViewGeometry& geometry, const PointMatch& m) const {
    return judge_match(camera, geometry, m, config);
  }

  [[nodiscard]] TwoViewGeometry geometry(
      const std::vector<PointMatch>& environment,
      const std::optional<Eigen::Isometry3d>& guess = std::nullopt) const {
    std::mt19937 rng = rng_for(1, FrameId(7), RandomPurpose::kEpipolarGeometry);
    return estimate_two_view(camera, environment, guess, config, rng);
  }

  CameraModel camera = builtin_camera("tum_fr3");
  StaticMatchesConfig config;

 private:
  Eigen::Isometry3d T_;
  double noise_px_;
  std::mt19937 rng_{42};
};

Eigen::Isometry3d motion(const Eigen::Vector3d& t, const Eigen::Vector3d& w) {
  return make_pose(so3_exp(w), t);
}

const Eigen::Isometry3d kSideways = motion({0.04, 0.01, 0.005}, {0.01, -0.02, 0.005});
const Eigen::Isometry3d kTurn = motion(Eigen::Vector3d::Zero(), {0.01, -0.03, 0.01});
const Eigen::Isometry3d kAhead = motion({0, 0, -0.05}, {0.002, 0.003, 0});

std::vector<PointMatch> without_depth(std::vector<PointMatch> matches) {
  for (PointMatch& match : matches) match.previous_depth_m = match.current_depth_m = 0;
  return matches;
}

TEST(Epipolar, DistanceIsThatOfPointAndLineByHand) {
  // A camera that moves along x has level lines: [t]x with t = (1, 0, 0).
  Eigen::Matrix3d F;
  F << 0, 0, 0, 0, 0, -1, 0, 1, 0;
  EXPECT_DOUBLE_EQ(epipolar_distance(F, {{10, 20}, {300, 23.5}}), 3.5);
  EXPECT_DOUBLE_EQ(epipolar_distance(F, {{10, 20}, {-7, 20}}), 0.0);
}

TEST(Epipolar, EightPointFindsTheMatrixOfTheMotion) {
  TwoViews views(kSideways, 0.0);
  const std::vector<PointMatch> room = views.room(30);
  const std::optional<Eigen::Matrix3d> F = eight_point(room);
  ASSERT_TRUE(F);
  Eigen::Matrix3d truth = fundamental_of_motion(views.camera, kSideways);
  truth /= truth.norm();
  EXPECT_LT(std::min((*F - truth).norm(), (*F + truth).norm()), 1e-6);
  EXPECT_LT(std::abs(F->determinant()), 1e-15);
  EXPECT_FALSE(eight_point(std::span(room).first(7)));
}

TEST(Epipolar, RansacLeavesOutTheWrongThirdAndIsRepeatable) {
  TwoViews views(kSideways);
  const std::vector<PointMatch> room = views.room(200, 66);
  std::mt19937 rng(3), again(3);
  const auto found = estimate_fundamental(room, 1.0, 500, rng);
  ASSERT_TRUE(found);
  int right_lost = 0, wrong_kept = 0;
  for (std::size_t i = 0; i < room.size(); ++i) {
    const bool wrong = i < 66;
    wrong_kept += wrong && found->inlier[i] != 0 ? 1 : 0;
    right_lost += !wrong && found->inlier[i] == 0 ? 1 : 0;
  }
  EXPECT_LE(right_lost, 3);
  EXPECT_LE(wrong_kept, 5);  // some are on their line by chance
  EXPECT_EQ(found->F, estimate_fundamental(room, 1.0, 500, again)->F);
}

TEST(StaticMatches, FindTheMotionAmongWrongMatches) {
  TwoViews views(kSideways);
  views.config.motion_check = true;
  const std::optional<Eigen::Isometry3d> T = views.geometry(views.room(200, 60)).T;
  ASSERT_TRUE(T);
  EXPECT_LT((T->translation() - kSideways.translation()).norm(), 0.001);
  EXPECT_LT(rotation_angle(T->linear().transpose() * kSideways.linear()), 0.0005);
  EXPECT_FALSE(views.geometry(without_depth(views.room(50))).T);
}

TEST(RayRotation, IsTheTurn) {
  TwoViews views(kTurn);
  const Eigen::Matrix3d R = ray_rotation(views.camera, views.room(100, 20));
  EXPECT_LT(rotation_angle(R.transpose() * kTurn.linear()), 0.0005);
}

TEST(StaticMatches, WhatStandsAndWhatCrossesTheLinesIsToldApart) {
  TwoViews views(kSideways);
  views.config.motion_check = true;
  for (const bool depth : {true, false}) {
    std::vector<PointMatch> room = views.room(150, 30);
    if (!depth) room = without_depth(room);
    const TwoViewGeometry geometry = views.geometry(room);
    ASSERT_TRUE(geometry.F && geometry.estimated());
    EXPECT_EQ(geometry.T.has_value(), depth);
    int lost = 0, missed = 0;
    for (int i = 0; i < 100; ++i) {
      std::vector<PointMatch> both = {
          views.standing(),
          views.match({views.between(100, 500), views.between(100, 400)}, 2.0, {0, 0.04, 0})};
      if (!depth) both = without_depth(both);
      lost += views.judge(geometry, both[0]) == MatchVerdict::kStatic ? 0 : 1;
      missed += views.judge(geometry, both[1]) == MatchVerdict::kDynamic ? 0 : 1;
    }
    EXPECT_LE(lost, 8) << depth;
    EXPECT_LE(missed, 2) << depth;
  }
}

// The epipolar lines of a camera that moves forward meet in the middle: a person who approaches
// moves along them.
TEST(StaticMatches, MotionAlongTheLineIsSeenByDepthAlone) {
  TwoViews views(kAhead);
  views.config.motion_check = true;
  const std::vector<PointMatch> room = views.room(150);
  const TwoViewGeometry geometry = views.geometry(room);
  ASSERT_TRUE(geometry.F && geometry.T);
  int seen = 0, seen_by_line = 0;
  for (int i = 0; i < 50; ++i) {
    const PointMatch comes =
        views.match({views.between(150, 500), views.between(100, 400)}, 1.5, {0, 0, -0.15});
    seen += views.judge(geometry, comes) == MatchVerdict::kDynamic ? 1 : 0;
    const PointMatch depthless = without_depth({comes}).front();
    seen_by_line += views.judge(geometry, depthless) == MatchVerdict::kDynamic ? 1 : 0;
  }
  EXPECT_EQ(seen, 50);
  EXPECT_LE(seen_by_line, 25);
}

TEST(StaticMatches, ACameraThatOnlyTurnsHasNoLinesAndStillJudges) {
  TwoViews views(kTurn);
  views.config.min_parallax_px = 0.7;
  for (const bool depth : {true, false}) {
    std::vector<PointMatch> room = views.room(150, 30);
    if (!depth) room = without_depth(room);
    const TwoViewGeometry geometry = views.geometry(room);
    EXPECT_FALSE(geometry.F);
    ASSERT_TRUE(geometry.R);
    for (int i = 0; i < 50; ++i) {
      std::vector<PointMatch> both = {
          views.standing(),
          views.match({views.between(100, 500), views.between(100, 400)}, 2.0, {0.04, 0, 0})};
      if (!depth) both = without_depth(both);
      EXPECT_EQ(views.judge(geometry, both[0]), MatchVerdict::kStatic);
      EXPECT_EQ(views.judge(geometry, both[1]), MatchVerdict::kDynamic);
    }
  }
}

TEST(StaticMatches, AStandingCameraIsNoCameraThatKnowsNothing) {
  TwoViews views(Eigen::Isometry3d::Identity());
  views.config.min_parallax_px = 0.7;
  const TwoViewGeometry geometry = views.geometry(views.room(100));
  EXPECT_FALSE(geometry.F);
  EXPECT_EQ(geometry.judge, MatchJudge::kRotation);
  EXPECT_EQ(views.judge(geometry, views.standing()), MatchVerdict::kStatic);
  EXPECT_EQ(views.judge(geometry, views.match({300, 200}, 2.0, {0.05, 0, 0})),
            MatchVerdict::kDynamic);
}

// Eq. (17) on numbers: level lines, so that the distance is the difference of the rows.
TEST(StaticMatches, OfEquation17ByHand) {
  const TwoViews views(kSideways);
  TwoViewGeometry geometry;
  geometry.judge = MatchJudge::kFundamental;
  geometry.F.emplace();
  *geometry.F << 0, 0, 0, 0, 0, -1, 0, 1, 0;
  EXPECT_EQ(views.judge(geometry, {{10, 20}, {300, 20.5}, 2, 2}), MatchVerdict::kStatic);
  EXPECT_EQ(views.judge(geometry, {{10, 20}, {300, 20.51}, 2, 2}), MatchVerdict::kDynamic);
  EXPECT_EQ(views.judge(geometry, {{10, 20}, {300, 19.5}, 2, 2}), MatchVerdict::kStatic);
  EXPECT_EQ(views.judge(geometry, {{10, 20}, {300, 19.49}, 2, 2}), MatchVerdict::kDynamic);
}

// The matrix of a camera that stands or only turns is any of many, each with lines through the
// points: what moves leaves them unless it moves along them, which one direction in some does.
TEST(StaticMatches, TheLineJudgesWithoutParallaxToo) {
  for (const Eigen::Isometry3d& T : {Eigen::Isometry3d::Identity(), kTurn}) {
    TwoViews views(T);
    const TwoViewGeometry geometry = views.geometry(views.room(150));
    ASSERT_EQ(geometry.judge, MatchJudge::kFundamental);
    EXPECT_FALSE(geometry.T);
    int kept = 0, found = 0;
    for (int i = 0; i < 100; ++i) {
      kept += views.judge(geometry, views.standing()) == MatchVerdict::kStatic ? 1 : 0;
      const Eigen::Vector3d way(views.between(-0.06, 0.06), views.between(-0.06, 0.06), 0);
      const Eigen::Vector2d px(views.between(100, 500), views.between(100, 400));
      found += views.judge(geometry, views.match(px, 2.0, way)) == MatchVerdict::kDynamic ? 1 : 0;
    }
    EXPECT_GE(kept, 95);
    EXPECT_GE(found, 80);
  }
}

TEST(StaticMatches, WithFewMatchesTheExpectedMotionDecides) {
  TwoViews views(kSideways);
  const TwoViewGeometry geometry = views.geometry(views.room(5), kSideways);
  ASSERT_TRUE(geometry.F && geometry.T);
  EXPECT_FALSE(geometry.estimated());
  for (int i = 0; i < 50; ++i) {
    const PointMatch stands = views.standing();
    const PointMatch moves = views.match({200.0 + i, 240}, 2.0, {0, 0.06, 0});
    EXPECT_EQ(views.judge(geometry, stands), MatchVerdict::kStatic);
    EXPECT_EQ(views.judge(geometry, without_depth({stands}).front()), MatchVerdict::kStatic);
    EXPECT_EQ(views.judge(geometry, moves), MatchVerdict::kDynamic);
    EXPECT_EQ(views.judge(geometry, without_depth({moves}).front()), MatchVerdict::kDynamic);
  }
}

TEST(StaticMatches, WithFewMatchesAndNoExpectationNothingIsKnown) {
  TwoViews views(kSideways);
  const TwoViewGeometry geometry = views.geometry(views.room(5));
  EXPECT_EQ(views.judge(geometry, views.standing()), MatchVerdict::kUnknown);
}

TEST(StaticMatches, MatchesOfChanceAloneGiveNoGeometry) {
  TwoViews views(kSideways);
  const TwoViewGeometry geometry = views.geometry(views.room(60, 60), kSideways);
  EXPECT_FALSE(geometry.estimated());
  EXPECT_EQ(geometry.T->matrix(), kSideways.matrix());
}

}  // namespace
}  // namespace stillmap
