// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/ate.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/trajectories.hpp"

namespace stillmap {
namespace {

Trajectory at_positions(const std::vector<Eigen::Vector3d>& positions, double start_s) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    StampedPose pose;
    pose.stamp = {start_s + static_cast<double>(i), fmt::format("pose {}", i)};
    pose.T_world_camera.translation() = positions[i];
    trajectory.push_back(pose);
  }
  return trajectory;
}

// Ends of a cross of arms 1, and of one of arms 1.1 and 1.2: any rotation or shift increases the
// sum of squares, so that the remaining error is known.
const std::vector<Eigen::Vector3d> kTruth = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
const std::vector<Eigen::Vector3d> kLarger = {{1.1, 0, 0}, {-1.1, 0, 0}, {0, 1.2, 0}, {0, -1.2, 0}};

TEST(AbsoluteTrajectoryError, LeavesTheResidualsThatNoMotionCanRemove) {
  const Eigen::Isometry3d T_truth_estimate =
      make_pose(so3_exp(Eigen::Vector3d(0.4, -1.1, 2.0)), {5.0, -7.0, 1.0});
  std::vector<Eigen::Vector3d> moved;
  for (const Eigen::Vector3d& p : kLarger) moved.push_back(T_truth_estimate.inverse() * p);
  const std::optional<AteResult> ate =
      absolute_trajectory_error(at_positions(kTruth, 10.0), at_positions(moved, 10.01));
  ASSERT_TRUE(ate);
  EXPECT_TRUE(ate->T_groundtruth_estimate.isApprox(T_truth_estimate, 1e-12));
  ASSERT_EQ(ate->pairs.size(), 4U);
  EXPECT_NEAR(ate->pairs[1].error_m, 0.1, 1e-12);
  EXPECT_NEAR(ate->pairs[2].error_m, 0.2, 1e-12);
  EXPECT_EQ(ate->pairs[2].stamp.text, "pose 2");
  EXPECT_EQ(ate->pairs[2].groundtruth, Eigen::Vector3d(0, 1, 0));
  EXPECT_LT((ate->pairs[2].estimate_aligned - Eigen::Vector3d(0, 1.2, 0)).norm(), 1e-12);
  EXPECT_NEAR(ate->translation_m.rmse, std::sqrt(0.025), 1e-12);
  EXPECT_NEAR(ate->translation_m.mean, 0.15, 1e-12);
  EXPECT_NEAR(ate->translation_m.median, 0.15, 1e-12);
  EXPECT_NEAR(ate->translation_m.std, 0.05, 1e-12);
  EXPECT_NEAR(ate->translation_m.min, 0.1, 1e-12);
  EXPECT_NEAR(ate->translation_m.max, 0.2, 1e-12);
}

TEST(FittedScale, IsThatOfLeastSquares) {
  const Eigen::Isometry3d T = make_pose(so3_exp(Eigen::Vector3d(0.4, -1.1, 2.0)), {5.0, -7.0, 1.0});
  std::vector<Eigen::Vector3d> moved;
  for (const Eigen::Vector3d& p : kLarger) moved.push_back(T * p);
  const std::optional<double> scale =
      fitted_scale(at_positions(kTruth, 10.0), at_positions(moved, 10.0));
  ASSERT_TRUE(scale);
  EXPECT_NEAR(*scale, (2 * 1.1 + 2 * 1.2) / (2 * 1.1 * 1.1 + 2 * 1.2 * 1.2), 1e-12);
}

TEST(FittedScale, HasTheLeastErrorOfAllScales) {
  const std::vector<Eigen::Vector3d> truth = {{0, 0, 0}, {1, 0.2, 0}, {2, 1, 0.5}, {2, 2, 0.4}};
  const std::vector<Eigen::Vector3d> estimate = {
      {0.1, 0, 0}, {0.3, 0.2, 0}, {0.9, 0.6, 0.2}, {1.1, 1.2, 0.3}};
  const auto rmse = [&](double scale) {
    std::vector<Eigen::Vector3d> scaled;
    for (const Eigen::Vector3d& p : estimate) scaled.push_back(scale * p);
    return absolute_trajectory_error(at_positions(truth, 1), at_positions(scaled, 1))
        ->translation_m.rmse;
  };
  double best = 0.5;
  for (double scale = 0.5; scale < 4; scale += 0.001) {
    if (rmse(scale) < rmse(best)) best = scale;
  }
  EXPECT_NEAR(*fitted_scale(at_positions(truth, 1), at_positions(estimate, 1)), best, 0.001);
}

TEST(FittedScale, NeedsMotion) {
  const std::vector<Eigen::Vector3d> still(4, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(fitted_scale(at_positions(kTruth, 1), at_positions(still, 1)));
  EXPECT_FALSE(fitted_scale(at_positions(kTruth, 1), at_positions(kTruth, 9)));
}

TEST(AbsoluteTrajectoryError, TakesAnotherDifferenceOfStamps) {
  const Trajectory truth = at_positions(kTruth, 10.0), late = at_positions(kTruth, 10.05);
  EXPECT_FALSE(absolute_trajectory_error(truth, late));
  EXPECT_EQ(absolute_trajectory_error(truth, late, 0.06)->pairs.size(), 4U);
}

TEST(AbsoluteTrajectoryError, CountsOnlyPosesWithGroundTruthNearInTime) {
  Trajectory truth = at_positions(kTruth, 10.0);
  Trajectory estimate = at_positions(kTruth, 10.0);
  estimate[3].stamp.seconds += 0.03;
  const std::optional<AteResult> ate = absolute_trajectory_error(truth, estimate);
  ASSERT_TRUE(ate);
  EXPECT_EQ(ate->pairs.size(), 3U);
  EXPECT_LT(ate->translation_m.max, 1e-12);
}

TEST(AbsoluteTrajectoryError, IsNothingWithoutThreePairs) {
  EXPECT_FALSE(absolute_trajectory_error(at_positions(kTruth, 0.0), at_positions(kTruth, 100.0)));
  EXPECT_FALSE(absolute_trajectory_error(at_positions(kTruth, 0.0), at_positions(kTruth, 2.0)));
  EXPECT_FALSE(absolute_trajectory_error({}, {}));
}

TEST(AbsoluteTrajectoryError, EqualsTheScriptOnPublishedTrajectories) {
  STILLMAP_NEED_SHARED_DATA("trajectories");
  const std::filesystem::path folder = shared_data("trajectories");
  for (const PublishedFigures& expected : kPublished) {
    SCOPED_TRACE(expected.name);
    const std::string name = expected.name;
    const std::optional<AteResult> ate =
        absolute_trajectory_error(read_trajectory(folder / (name + ".groundtruth.txt")),
                                  read_trajectory(folder / (name + ".v3d-slam.txt")));
    ASSERT_TRUE(ate);
    EXPECT_EQ(ate->pairs.size(), expected.ate_pairs);
    EXPECT_NEAR(ate->translation_m.rmse, expected.ate_rmse, 1e-6);
    EXPECT_NEAR(ate->translation_m.mean, expected.ate_mean, 1e-6);
    EXPECT_NEAR(ate->translation_m.median, expected.ate_median, 1e-6);
    EXPECT_NEAR(ate->translation_m.std, expected.ate_std, 1e-6);
  }
}

}  // namespace
}  // namespace stillmap
