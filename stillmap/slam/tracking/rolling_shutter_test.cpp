// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/tracking/rolling_shutter.hpp"

#include <gtest/gtest.h>

#include "stillmap/slam/optim/measurement_model.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/simulated_world.hpp"

namespace stillmap {
namespace {

// Walks and turns at constant velocities: `velocity()` in the camera's axes at time 0.
Eigen::Isometry3d steady(double time_s) {
  return make_pose(so3_exp(time_s * Eigen::Vector3d(0.2, -0.4, 0.3)),
                   time_s * Eigen::Vector3d(0.4, -0.3, 0.5));
}
CameraVelocity steady_velocity() {
  return {{0.4, -0.3, 0.5}, {0.2, -0.4, 0.3}};
}

const SimulatedWorld& test_world() {
  static const SimulatedWorld world({}, simulated_camera());
  return world;
}

double largest_error_px(const Features& features, const std::vector<std::uint32_t>& points) {
  double largest = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Eigen::Vector2d truth =
        test_world().camera().project(test_world().points()[points[i]].position);
    largest = std::max(largest, (features.px[i].cast<double>() - truth).norm());
  }
  return largest;
}

TEST(CameraVelocity, OfAPointIsItsNumericDerivative) {
  const Eigen::Vector3d p_world(0.3, -0.5, 2.0);
  constexpr double kStep = 1e-5;
  const Eigen::Vector3d numeric =
      (steady(kStep).inverse() * p_world - steady(-kStep).inverse() * p_world) / (2 * kStep);
  EXPECT_LT((steady_velocity().of_point(p_world) - numeric).norm(), 1e-8);
}

TEST(MeanVelocity, IsTheMotionOverItsTime) {
  const CameraVelocity v = mean_velocity(
      make_pose(so3_exp(Eigen::Vector3d(0, 0.1, 0)), Eigen::Vector3d(0.2, 0, -0.1)), 0.5);
  EXPECT_LT((v.linear - Eigen::Vector3d(0.4, 0, -0.2)).norm(), 1e-12);
  EXPECT_LT((v.angular - Eigen::Vector3d(0, 0.2, 0)).norm(), 1e-12);
  EXPECT_EQ(mean_velocity(steady(1), 0).linear.norm(), 0);
  EXPECT_EQ(mean_velocity(steady(1), -1).angular.norm(), 0);
}

TEST(UndoRollingShutter, RestoresTheInstantOfTheMiddleRowToFirstOrder) {
  std::vector<double> left_px;
  for (const double readout_s : {0.03, 0.015}) {
    std::mt19937 rng(1);
    const Observed seen = test_world().observe_rolling(steady, 0, readout_s, {}, rng);
    ASSERT_GT(seen.features.size(), 200U);
    const Features undone =
        undo_rolling_shutter(seen.features, test_world().camera(), readout_s, steady_velocity());
    EXPECT_GT(largest_error_px(seen.features, seen.points), 100 * readout_s);
    left_px.push_back(largest_error_px(undone, seen.points));
    for (std::size_t i = 0; i < undone.size(); ++i) {
      const double z = test_world().points()[seen.points[i]].position.z();
      EXPECT_NEAR(undone.depth_m[i], z, 5e-4);
      EXPECT_EQ(undone.raw_px[i], seen.features.raw_px[i]);
      EXPECT_EQ(undone.sensor_depth_m[i], seen.features.sensor_depth_m[i]);
    }
  }
  EXPECT_LT(left_px[0], 0.1);
  EXPECT_NEAR(left_px[0] / left_px[1], 4.0, 0.7);  // what is left is of second order
}

TEST(UndoRollingShutter, ChangesNothingWithAGlobalShutterOrAStandingCamera) {
  std::mt19937 rng(1);
  const Observed seen = test_world().observe(steady(0), {.missing_depth_share = 0.3}, rng);
  const Features global =
      undo_rolling_shutter(seen.features, test_world().camera(), 0, steady_velocity());
  const Features standing = undo_rolling_shutter(seen.features, test_world().camera(), 0.03, {});
  for (std::size_t i = 0; i < seen.features.size(); ++i) {
    for (const Features* undone : {&global, &standing}) {
      EXPECT_LT((undone->px[i] - seen.features.px[i]).norm(), 1e-4F);
      EXPECT_NEAR(undone->depth_m[i], seen.features.depth_m[i], 1e-6F);
    }
  }
}

TEST(UndoRollingShutter, TurnsFeaturesWithoutDepth) {
  const CameraPath turning = [](double t) {
    return make_pose(so3_exp(t * Eigen::Vector3d(0.2, -0.6, 0.5)), Eigen::Vector3d::Zero());
  };
  const CameraVelocity turn{Eigen::Vector3d::Zero(), {0.2, -0.6, 0.5}};
  std::mt19937 rng(1);
  const Observed seen =
      test_world().observe_rolling(turning, 0, 0.03, {.missing_depth_share = 1}, rng);
  const Features undone = undo_rolling_shutter(seen.features, test_world().camera(), 0.03, turn);
  EXPECT_GT(largest_error_px(seen.features, seen.points), 3.0);
  EXPECT_LT(largest_error_px(undone, seen.points), 0.1);
  EXPECT_EQ(undone.depth_m[0], 0);
}

TEST(UndoRollingShutter, SortsTheGridAnew) {
  std::mt19937 rng(1);
  const Observed seen = test_world().observe_rolling(steady, 0, 0.03, {}, rng);
  // Ten times as fast, so that features change their cells.
  const CameraVelocity fast{10 * steady_velocity().linear, 10 * steady_velocity().angular};
  const Features undone = undo_rolling_shutter(seen.features, test_world().camera(), 0.03, fast);
  for (std::uint32_t i = 0; i < undone.size(); ++i) {
    bool found = false;
    undone.grid.visit_near(undone.px[i], 1.0F, [&](std::uint32_t j) { found = found || j == i; });
    EXPECT_TRUE(found);
  }
}

struct LearningCase {
  double true_readout_s = 0;
  double speed = 1.0;
  int frames = 200;
  ObservationNoise noise{.pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.01};
  ShutterConfig config{};
  double stated_readout_s = 0;
};

// Follows a swinging camera whose poses are estimated from each frame's noisy features.
double learnt_readout(const LearningCase& c) {
  const SimulatedWorld& world = test_world();
  CameraModel camera = world.camera();
  camera.readout_s = c.stated_readout_s;
  ReadoutEstimator estimator(c.config, camera);
  const MeasurementModel measure({.pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.01},
                                 world.level_scales());
  const CameraPath path = [&](double t) { return swinging(t, c.speed); };
  std::mt19937 rng(7);
  for (int k = 1; k <= c.frames; ++k) {
    const double t = k * kFrameInterval_s;
    const Observed seen = world.observe_rolling(path, t, c.true_readout_s, c.noise, rng);
    const CameraVelocity velocity =
        mean_velocity(path(t - kFrameInterval_s).inverse() * path(t), kFrameInterval_s);
    const Features features =
        undo_rolling_shutter(seen.features, camera, estimator.readout_s(), velocity);
    std::vector<PoseObservation> observations;
    std::vector<double> rows;
    for (std::size_t i = 0; i < features.size(); ++i) {
      observations.push_back({world.points()[seen.points[i]].position, measure(features, i)});
      rows.push_back(static_cast<double>(features.raw_px[i].y()) / camera.height_px - 0.5);
    }
    const PoseEstimate pose = optimize_pose(camera, path(t).inverse(), observations);
    estimator.update(pose.T_camera_world, velocity, observations, rows);
  }
  return estimator.readout_s();
}

TEST(ReadoutEstimator, LearnsTheReadoutOfAMovingCamera) {
  for (const double truth : {0.005, 0.015, 0.03}) {
    const ShutterConfig any{.min_readout_s = 0};
    EXPECT_NEAR(learnt_readout({.true_readout_s = truth, .config = any}), truth, 1e-3);
  }
}

TEST(ReadoutEstimator, TakesAShortReadoutForAGlobalShutter) {
  EXPECT_EQ(learnt_readout({.true_readout_s = 0.008}), 0.0);
  EXPECT_NEAR(learnt_readout({.true_readout_s = 0.012}), 0.012, 1e-3);
}

TEST(ReadoutEstimator, FindsAGlobalShutter) {
  EXPECT_LT(learnt_readout({}), 1e-3);
  EXPECT_LT(learnt_readout({.stated_readout_s = 0.02}), 1e-3);  // stated wrongly
}

TEST(ReadoutEstimator, IsNotMisledByFeaturesWithoutDepth) {
  const ObservationNoise half_without{
      .pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.01, .missing_depth_share = 0.5};
  EXPECT_NEAR(learnt_readout({.true_readout_s = 0.015, .noise = half_without}), 0.015, 1e-3);
}

TEST(ReadoutEstimator, KeepsWhatItKnowsWhileTheCameraStands) {
  EXPECT_EQ(learnt_readout({.true_readout_s = 0.03, .speed = 0, .stated_readout_s = 0.02}), 0.02);
}

TEST(ReadoutEstimator, KeepsWhatIsStatedWhenNotToCalibrate) {
  ShutterConfig off;
  off.calibrate = false;
  EXPECT_EQ(learnt_readout(
                {.true_readout_s = 0.03, .frames = 20, .config = off, .stated_readout_s = 0.01}),
            0.01);
}

TEST(ReadoutEstimator, BelievesNoLongerReadoutThanAllowed) {
  ShutterConfig config{};
  config.max_readout_s = 0.02;
  EXPECT_EQ(learnt_readout({.true_readout_s = 0.03, .config = config}), 0.02);
}

}  // namespace
}  // namespace stillmap
