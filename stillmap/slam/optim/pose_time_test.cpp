// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/pose_time.hpp"

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

FeatureTiming rolling(double readout_s, const CameraVelocity& velocity) {
  return {velocity, velocity, 0, {readout_s, 0}};
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

TEST(AtPoseTime, RestoresTheInstantOfTheMiddleRowToFirstOrder) {
  std::vector<double> left_px;
  for (const double readout_s : {0.03, 0.015}) {
    std::mt19937 rng(1);
    const Observed seen = test_world().observe_rolling(steady, 0, readout_s, {}, rng);
    ASSERT_GT(seen.features.size(), 200U);
    const Features undone =
        at_pose_time(seen.features, test_world().camera(), rolling(readout_s, steady_velocity()));
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

TEST(AtPoseTime, ChangesNothingWithAGlobalShutterOrAStandingCamera) {
  std::mt19937 rng(1);
  const Observed seen = test_world().observe(steady(0), {.missing_depth_share = 0.3}, rng);
  const Features global =
      at_pose_time(seen.features, test_world().camera(), rolling(0, steady_velocity()));
  const Features standing = at_pose_time(seen.features, test_world().camera(), rolling(0.03, {}));
  for (std::size_t i = 0; i < seen.features.size(); ++i) {
    for (const Features* undone : {&global, &standing}) {
      EXPECT_LT((undone->px[i] - seen.features.px[i]).norm(), 1e-4F);
      EXPECT_NEAR(undone->depth_m[i], seen.features.depth_m[i], 1e-6F);
    }
  }
}

TEST(AtPoseTime, TurnsFeaturesWithoutDepth) {
  const CameraPath turning = [](double t) {
    return make_pose(so3_exp(t * Eigen::Vector3d(0.2, -0.6, 0.5)), Eigen::Vector3d::Zero());
  };
  const CameraVelocity turn{Eigen::Vector3d::Zero(), {0.2, -0.6, 0.5}};
  std::mt19937 rng(1);
  const Observed seen =
      test_world().observe_rolling(turning, 0, 0.03, {.missing_depth_share = 1}, rng);
  const Features undone = at_pose_time(seen.features, test_world().camera(), rolling(0.03, turn));
  EXPECT_GT(largest_error_px(seen.features, seen.points), 3.0);
  EXPECT_LT(largest_error_px(undone, seen.points), 0.1);
  EXPECT_EQ(undone.depth_m[0], 0);
}

TEST(AtPoseTime, SortsTheGridAnew) {
  std::mt19937 rng(1);
  const Observed seen = test_world().observe_rolling(steady, 0, 0.03, {}, rng);
  // Ten times as fast, so that features change their cells.
  const CameraVelocity fast{10 * steady_velocity().linear, 10 * steady_velocity().angular};
  const Features undone = at_pose_time(seen.features, test_world().camera(), rolling(0.03, fast));
  for (std::uint32_t i = 0; i < undone.size(); ++i) {
    bool found = false;
    undone.grid.visit_near(undone.px[i], 1.0F, [&](std::uint32_t j) { found = found || j == i; });
    EXPECT_TRUE(found);
  }
}

TEST(AtPoseTime, BringsLateDepthToTheTimeOfThePose) {
  constexpr double kLate_s = 0.02;
  std::mt19937 rng(1);
  Observed seen = test_world().observe(steady(0), {}, rng);
  for (std::size_t i = 0; i < seen.features.size(); ++i) {
    const Eigen::Vector3d& p = test_world().points()[seen.points[i]].position;
    seen.features.sensor_depth_m[i] = static_cast<float>((steady(kLate_s).inverse() * p).z());
  }
  // Stamps tell a part of it.
  const FeatureTiming timing{steady_velocity(), steady_velocity(), 0.015, {0, kLate_s - 0.015}};
  const Features undone = at_pose_time(seen.features, test_world().camera(), timing);
  double before = 0, after = 0;
  for (std::size_t i = 0; i < undone.size(); ++i) {
    const double truth = test_world().points()[seen.points[i]].position.z();
    before = std::max(before, std::abs(seen.features.sensor_depth_m[i] - truth));
    after = std::max(after, std::abs(undone.depth_m[i] - truth));
    EXPECT_LT((undone.px[i] - seen.features.px[i]).norm(), 1e-3F);
  }
  EXPECT_GT(before, 0.01);
  EXPECT_LT(after, 0.05 * before);
}

}  // namespace
}  // namespace stillmap
