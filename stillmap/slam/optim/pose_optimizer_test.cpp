// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/pose_optimizer.hpp"

#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/support/numeric_jacobian.hpp"
#include "tests/support/optim_problems.hpp"

namespace stillmap {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Eigen::Isometry3d moved(const Eigen::Isometry3d& T, std::uint32_t seed) {
  TestRandom random(seed);
  return perturb_left(T, random.twist(0.05, 0.05));
}

PoseEstimate optimize(const PoseScene& scene, const Eigen::Isometry3d& start) {
  return optimize_pose(scene.camera, start, scene.observations);
}

TEST(PoseOptimizer, RecoversThePoseFromExactData) {
  for (const Depths depths : {Depths::kNone, Depths::kSome, Depths::kAll}) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
      const PoseScene scene = make_pose_scene(seed, 60, depths, 0);
      const PoseEstimate estimate = optimize(scene, moved(scene.T_camera_world, seed + 100));
      EXPECT_LT(pose_distance(estimate.T_camera_world, scene.T_camera_world), 1e-9) << seed;
      EXPECT_EQ(estimate.inliers, 60) << seed;
    }
  }
}

// An observation that is given twice, trusted by half each time, counts once.
TEST(PoseOptimizer, TrustIsAWeight) {
  const PoseScene scene = make_pose_scene(7, 60, Depths::kSome, 0.5);
  PoseScene halves = scene;
  for (std::size_t i = 0; i < 30; ++i) {
    halves.observations[i].trust = 0.5;
    halves.observations.push_back(halves.observations[i]);
  }
  const Eigen::Isometry3d start = moved(scene.T_camera_world, 8);
  const Eigen::Isometry3d whole = optimize(scene, start).T_camera_world;
  EXPECT_LT(pose_distance(optimize(halves, start).T_camera_world, whole), 1e-7);
  for (PoseObservation& o : halves.observations) o.trust = 1;
  EXPECT_GT(pose_distance(optimize(halves, start).T_camera_world, whole), 1e-5);
}

TEST(PoseOptimizer, ThreePointsWithDepthAreEnough) {
  const PoseScene scene = make_pose_scene(5, 3, Depths::kAll, 0);
  const PoseEstimate estimate = optimize(scene, moved(scene.T_camera_world, 6));
  EXPECT_LT(pose_distance(estimate.T_camera_world, scene.T_camera_world), 1e-9);
}

// The error in units of its covariance, by numeric derivatives: chi-squared with 6 degrees of
// freedom for least squares. Cutting at the 95 % bound costs at most a quarter of the efficiency.
double normalized_error(const PoseScene& scene, const Eigen::Isometry3d& estimate) {
  const auto residuals = [&](const Eigen::VectorXd& step) -> Eigen::VectorXd {
    const Eigen::Isometry3d T = perturb_left(scene.T_camera_world, step);
    Eigen::VectorXd r(3 * scene.observations.size());
    for (std::size_t i = 0; i < scene.observations.size(); ++i) {
      const PoseObservation& o = scene.observations[i];
      r.segment<3>(static_cast<Eigen::Index>(3 * i)) =
          reprojection_residual(scene.camera, o.measurement, T * o.p_world);
    }
    return r;
  };
  const Eigen::MatrixXd J = numeric_jacobian(residuals, Eigen::VectorXd::Zero(6));
  const Eigen::Isometry3d between = estimate * scene.T_camera_world.inverse();
  const Eigen::Vector3d w = so3_log(Eigen::Quaterniond(between.linear()));
  Vector6d error;  // such that perturb_left(truth, error) is the estimate
  error << between.translation(), w;
  return (J * error).squaredNorm();
}

TEST(PoseOptimizer, ErrorsAgreeWithTheirCovariance) {
  constexpr int kTrials = 200;
  for (const Depths depths : {Depths::kNone, Depths::kAll}) {
    double sum = 0;
    for (std::uint32_t seed = 1; seed <= kTrials; ++seed) {
      const PoseScene scene = make_pose_scene(seed, 100, depths, 1.0);
      sum += normalized_error(scene, optimize(scene, scene.T_camera_world).T_camera_world);
    }
    // The mean of 200 draws of chi2(6) has a deviation of 0.25.
    EXPECT_GT(sum / kTrials, 6.0 - 0.75);
    EXPECT_LT(sum / kTrials, 1.25 * 6.0 + 0.75);
  }
}

TEST(PoseOptimizer, FindsGrossOutliersAndStays) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    PoseScene scene = make_pose_scene(seed, 200, Depths::kSome, 1.0);
    TestRandom random(seed + 1000);
    for (std::size_t i = 0; i < 60; ++i) {
      const double angle = random.uniform(0, 6.28), length = random.uniform(30, 200);
      scene.observations[i].measurement.px +=
          length * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    }
    const PoseEstimate estimate = optimize(scene, moved(scene.T_camera_world, seed + 100));
    const auto good = estimate.inlier.begin() + 60;
    EXPECT_EQ(std::accumulate(estimate.inlier.begin(), good, 0), 0) << seed;
    // 95 % of 140 are 133, with a deviation of 2.6.
    EXPECT_GE(std::accumulate(good, estimate.inlier.end(), 0), 122) << seed;
    EXPECT_EQ(std::accumulate(estimate.inlier.begin(), estimate.inlier.end(), 0), estimate.inliers);
    scene.observations.erase(scene.observations.begin(), scene.observations.begin() + 60);
    EXPECT_LT(normalized_error(scene, estimate.T_camera_world), 30.0) << seed;  // chi2(6), 4e-5
  }
}

TEST(PoseOptimizer, WithFewerThanThreeObservationsThePoseIsReturnedAsGiven) {
  for (const int count : {0, 1, 2}) {
    const PoseScene scene = make_pose_scene(9, count, Depths::kAll, 0);
    const Eigen::Isometry3d start = moved(scene.T_camera_world, 10);
    const PoseEstimate estimate = optimize(scene, start);
    EXPECT_EQ(estimate.T_camera_world.matrix(), start.matrix());
    EXPECT_EQ(estimate.inliers, 0);
    EXPECT_EQ(estimate.inlier, std::vector<std::uint8_t>(static_cast<std::size_t>(count), 0));
  }
}

TEST(PoseOptimizer, PointsBehindTheCameraAreOutliersAndDoNotDisturb) {
  PoseScene scene = make_pose_scene(11, 60, Depths::kSome, 0);
  for (std::size_t i = 0; i < 60; i += 5) {
    const Eigen::Vector3d p_camera = scene.T_camera_world * scene.observations[i].p_world;
    scene.observations[i].p_world = scene.T_camera_world.inverse() * Eigen::Vector3d(-p_camera);
  }
  const PoseEstimate estimate = optimize(scene, moved(scene.T_camera_world, 12));
  EXPECT_LT(pose_distance(estimate.T_camera_world, scene.T_camera_world), 1e-9);
  for (std::size_t i = 0; i < 60; ++i) EXPECT_EQ(estimate.inlier[i], i % 5 == 0 ? 0 : 1) << i;
}

TEST(PoseOptimizer, WithAllPointsBehindTheCameraThePoseIsReturnedAsGiven) {
  PoseScene scene = make_pose_scene(13, 30, Depths::kSome, 0);
  const Eigen::Isometry3d back =
      make_pose(so3_exp({0, 3.14159, 0}), Eigen::Vector3d::Zero()) * scene.T_camera_world;
  const PoseEstimate estimate = optimize(scene, back);
  EXPECT_EQ(estimate.inliers, 0);
  EXPECT_LT(pose_distance(estimate.T_camera_world, back), 1e-12);
}

TEST(PoseOptimizer, ObservationsThatAreNoNumbersAreOutliersAndDoNotDisturb) {
  PoseScene scene = make_pose_scene(14, 60, Depths::kAll, 0);
  scene.observations[3].p_world.x() = kNan;
  scene.observations[9].p_world.z() = kNan;
  scene.observations[17].measurement.px.y() = kNan;
  scene.observations[30].measurement.inverse_depth = std::numeric_limits<double>::infinity();
  const PoseEstimate estimate = optimize(scene, moved(scene.T_camera_world, 15));
  EXPECT_LT(pose_distance(estimate.T_camera_world, scene.T_camera_world), 1e-9);
  EXPECT_EQ(estimate.inliers, 56);
  for (const std::size_t i : {3U, 9U, 17U, 30U}) EXPECT_EQ(estimate.inlier[i], 0) << i;
}

TEST(PoseOptimizer, DegenerateInputStaysFinite) {
  // All observations of one point: four of the six directions are undetermined.
  PoseScene scene = make_pose_scene(16, 1, Depths::kNone, 0);
  scene.observations.assign(10, scene.observations.front());
  const PoseEstimate one_point = optimize(scene, moved(scene.T_camera_world, 17));
  EXPECT_TRUE(one_point.T_camera_world.matrix().allFinite());
  EXPECT_EQ(one_point.inliers, 10);

  // Weights and coordinates far from anything real.
  for (const double scale : {1e-200, 1e-30, 1e30, 1e200}) {
    PoseScene extreme = make_pose_scene(18, 20, Depths::kAll, 1.0);
    for (std::size_t i = 0; i < 20; ++i) {
      if (i % 2 == 0) extreme.observations[i].measurement.pixel_weight *= scale;
      if (i % 3 == 0) extreme.observations[i].p_world *= scale;
      if (i % 5 == 0) extreme.observations[i].measurement.inverse_depth_weight *= scale;
    }
    const PoseEstimate estimate = optimize(extreme, moved(extreme.T_camera_world, 19));
    EXPECT_TRUE(estimate.T_camera_world.matrix().allFinite()) << scale;
  }
}

TEST(PoseOptimizer, EqualInputGivesEqualBits) {
  const PoseScene scene = make_pose_scene(20, 150, Depths::kSome, 1.0);
  const Eigen::Isometry3d start = moved(scene.T_camera_world, 21);
  const PoseEstimate a = optimize(scene, start), b = optimize(scene, start);
  EXPECT_EQ(a.T_camera_world.matrix(), b.T_camera_world.matrix());
  EXPECT_EQ(a.inlier, b.inlier);
}

}  // namespace
}  // namespace stillmap
