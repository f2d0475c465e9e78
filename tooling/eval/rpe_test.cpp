// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/rpe.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/trajectories.hpp"

namespace stillmap {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// 5 s of poses, eight a second (stamps that a double holds exactly).
Trajectory five_seconds(const std::function<Eigen::Isometry3d(double)>& pose) {
  return make_trajectory(41, 100.0, 0.125, pose);
}

Eigen::Isometry3d still(double) {
  return Eigen::Isometry3d::Identity();
}

Eigen::Isometry3d drifting(double seconds) {
  return make_pose(Eigen::Quaterniond::Identity(), {0.03 * seconds, 0, 0});
}

Eigen::Isometry3d turning(double seconds) {
  return make_pose(so3_exp(Eigen::Vector3d(0, 0, 2.0 * kDegree * seconds)), {0, 0, 0});
}

TEST(RelativePoseError, IsTheDriftInASecond) {
  const std::optional<RpeResult> rpe =
      relative_pose_error(five_seconds(still), five_seconds(drifting));
  ASSERT_TRUE(rpe);
  EXPECT_NEAR(rpe->translation_m.rmse, 0.03, 1e-12);
  EXPECT_NEAR(rpe->translation_m.max, 0.03, 1e-12);
  EXPECT_NEAR(rpe->rotation_deg.max, 0.0, 2e-6);  // what an arc cosine near 1 resolves
  const std::optional<RpeResult> half =
      relative_pose_error(five_seconds(still), five_seconds(drifting), 0.5);
  ASSERT_TRUE(half);
  EXPECT_EQ(half->delta_s, 0.5);
  EXPECT_NEAR(half->translation_m.rmse, 0.015, 1e-12);
}

TEST(RelativePoseError, IsTheTurnInASecondInDegrees) {
  const std::optional<RpeResult> rpe =
      relative_pose_error(five_seconds(still), five_seconds(turning));
  ASSERT_TRUE(rpe);
  EXPECT_NEAR(rpe->rotation_deg.rmse, 2.0, 1e-9);
  EXPECT_NEAR(rpe->rotation_deg.min, 2.0, 1e-9);
  EXPECT_NEAR(rpe->translation_m.max, 0.0, 1e-12);
}

TEST(RelativePoseError, LeavesOutPairsThatEndAtTheLastPose) {
  // Poses 0 to 40; pairs (i, i + 8) with i + 8 < 40.
  const std::optional<RpeResult> rpe =
      relative_pose_error(five_seconds(still), five_seconds(drifting));
  ASSERT_TRUE(rpe);
  EXPECT_EQ(rpe->pairs, 32U);
}

// The estimate is the truth, with a pose every 0.13 s where the truth has one every 0.125 s.
TEST(RelativePoseError, OfSparseGroundTruthIsThatOfTheTimeBetweenUnlessInterpolated) {
  const Trajectory truth = five_seconds(drifting);
  const Trajectory estimate = make_trajectory(38, 100.0, 0.13, drifting);
  EXPECT_NEAR(groundtruth_distance_s(truth, estimate), 0.0625, 0.01);
  EXPECT_EQ(groundtruth_distance_s(truth, truth), 0.0);
  EXPECT_GT(relative_pose_error(truth, estimate)->translation_m.max, 1e-3);
  const std::optional<RpeResult> interpolated = interpolated_relative_pose_error(truth, estimate);
  ASSERT_TRUE(interpolated);
  EXPECT_LT(interpolated->translation_m.max, 1e-12);
  EXPECT_GT(interpolated->pairs, 25U);
}

TEST(RelativePoseError, InterpolatesNotOverAGap) {
  Trajectory truth;
  for (const StampedPose& pose : five_seconds(still)) {
    const double seconds = pose.stamp.seconds - 100.0;
    if (seconds <= 2.0 || seconds >= 3.5) truth.push_back(pose);
  }
  // Estimated poses between the true ones, 2 s to 3.5 s apart, have no truth.
  Trajectory estimate;
  for (const StampedPose& pose : five_seconds(drifting)) {
    const double seconds = pose.stamp.seconds - 100.0;
    if (seconds <= 2.0 || seconds >= 3.5) estimate.push_back(pose);
  }
  const auto with_gap = interpolated_relative_pose_error(truth, five_seconds(drifting));
  const auto without = relative_pose_error(truth, estimate);
  ASSERT_TRUE(with_gap && without);
  EXPECT_EQ(with_gap->pairs, without->pairs);
  EXPECT_EQ(with_gap->translation_m.rmse, without->translation_m.rmse);
}

TEST(RelativePoseError, LeavesOutPairsInAGapOfTheGroundTruth) {
  Trajectory truth;
  for (const StampedPose& pose : five_seconds(still)) {
    const double seconds = pose.stamp.seconds - 100.0;
    if (seconds <= 2.0 || seconds >= 3.5) truth.push_back(pose);
  }
  // The median interval is 0.125 s. More than 0.25 s from any truth are 2.375 to 3.125, seven
  // poses; each begins one pair and ends one, of 32.
  const std::optional<RpeResult> rpe = relative_pose_error(truth, five_seconds(drifting));
  ASSERT_TRUE(rpe);
  EXPECT_EQ(rpe->pairs, 18U);
}

TEST(RelativePoseError, HasTheErrorInTheScriptsOrder) {
  // In each second the truth goes 1 m ahead; the estimate does too and then turns by 90 degrees.
  // The textbook's (gt_i^-1 gt_j)^-1 (est_i^-1 est_j) moves nothing; the script's product moves by
  // (1,0,0) - (0,1,0).
  const Eigen::Isometry3d step =
      make_pose(so3_exp(Eigen::Vector3d(0, 0, 90 * kDegree)), {1.0, 0, 0});
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Trajectory estimate = make_trajectory(6, 0.0, 1.0, [&](double) {
    const Eigen::Isometry3d here = pose;
    pose = pose * step;
    return here;
  });
  const Trajectory truth = make_trajectory(6, 0.0, 1.0, [](double seconds) {
    return make_pose(Eigen::Quaterniond::Identity(), {seconds, 0, 0});
  });
  const std::optional<RpeResult> rpe = relative_pose_error(truth, estimate);
  ASSERT_TRUE(rpe);
  EXPECT_EQ(rpe->pairs, 4U);
  EXPECT_NEAR(rpe->translation_m.rmse, std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(rpe->rotation_deg.rmse, 90.0, 1e-9);
}

TEST(RelativePoseError, DoesNotDependOnTheFrames) {
  const Eigen::Isometry3d T = make_pose(so3_exp(Eigen::Vector3d(1, 2, -1)), {4, 5, 6});
  const Trajectory moved =
      five_seconds([&](double seconds) -> Eigen::Isometry3d { return T * drifting(seconds); });
  const std::optional<RpeResult> rpe = relative_pose_error(five_seconds(turning), moved);
  const std::optional<RpeResult> reference =
      relative_pose_error(five_seconds(turning), five_seconds(drifting));
  ASSERT_TRUE(rpe && reference);
  EXPECT_NEAR(rpe->translation_m.rmse, reference->translation_m.rmse, 1e-12);
  EXPECT_NEAR(rpe->rotation_deg.rmse, reference->rotation_deg.rmse, 1e-9);
}

TEST(RelativePoseError, IsNothingWithoutPairs) {
  const Trajectory some = five_seconds(still);
  EXPECT_FALSE(relative_pose_error(some, {}));
  EXPECT_FALSE(relative_pose_error({}, some));
  EXPECT_FALSE(relative_pose_error(some, make_trajectory(41, 900.0, 0.125, still)));
  EXPECT_FALSE(relative_pose_error(some, make_trajectory(5, 100.0, 0.125, still)));
}

TEST(RelativePoseError, EqualsTheScriptOnPublishedTrajectories) {
  STILLMAP_NEED_SHARED_DATA("trajectories");
  const std::filesystem::path folder = shared_data("trajectories");
  for (const PublishedFigures& expected : kPublished) {
    SCOPED_TRACE(expected.name);
    const std::string name = expected.name;
    const std::optional<RpeResult> rpe =
        relative_pose_error(read_trajectory(folder / (name + ".groundtruth.txt")),
                            read_trajectory(folder / (name + ".v3d-slam.txt")));
    ASSERT_TRUE(rpe);
    EXPECT_EQ(rpe->pairs, expected.rpe_pairs);
    EXPECT_NEAR(rpe->translation_m.rmse, expected.rpe_translation_rmse, 1e-6);
    EXPECT_NEAR(rpe->rotation_deg.rmse, expected.rpe_rotation_rmse_deg, 1e-6);
  }
}

}  // namespace
}  // namespace stillmap
