// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/map_alignment.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "stillmap/geometry/se3.hpp"
#include "tests/support/trajectories.hpp"
#include "tooling/eval/ate.hpp"

namespace stillmap {
namespace {

const Eigen::Isometry3d kTruthEstimate = make_pose(so3_exp({0.4, -1, 2}), {5, 6, -7});

Trajectory in_truth(Trajectory trajectory) {
  for (StampedPose& pose : trajectory) pose.T_world_camera = kTruthEstimate * pose.T_world_camera;
  return trajectory;
}

double distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.matrix() - b.matrix()).norm();
}

TEST(MapAlignment, FindsTheTransformOfAnyPath) {
  const auto still = [](double) { return make_pose(so3_exp({0.1, 0.2, 0.3}), {1, 2, 3}); };
  const auto line = [](double t) { return make_pose(so3_exp({0, 0, 0}), {t, 2 * t, 0}); };
  const auto curve = [](double t) {
    return make_pose(so3_exp({t, 0, 0}), {t, t * t, std::sin(t)});
  };
  for (const std::function<Eigen::Isometry3d(double)>& path :
       {std::function<Eigen::Isometry3d(double)>(still), {line}, {curve}}) {
    const Trajectory estimate = make_trajectory(20, 1, 0.1, path);
    EXPECT_LT(distance(*map_alignment(in_truth(estimate), estimate), kTruthEstimate), 1e-9);
  }
}

// A camera that trembles by 1 mm, with estimates of the same accuracy.
TEST(MapAlignment, StaysPutWhereTheTrajectorysOwnDoesNot) {
  const auto tremble = [](double scale) {
    return make_trajectory(50, 1, 0.1, [scale](double t) {
      const Eigen::Vector3d p(std::sin(31 * t), std::sin(17 * t + scale), std::sin(23 * t * scale));
      return make_pose(so3_exp(0.001 * p), 0.001 * p);
    });
  };
  const Trajectory estimate = tremble(1), truth = in_truth(tremble(2));
  const auto degrees_off = [](const Eigen::Isometry3d& T) {
    return rotation_angle(T.linear() * kTruthEstimate.linear().transpose()) * 180 / 3.14159265;
  };
  EXPECT_LT(degrees_off(*map_alignment(truth, estimate)), 0.1);
  EXPECT_GT(degrees_off(absolute_trajectory_error(truth, estimate)->T_groundtruth_estimate), 2);
}

// Positions are turned about z by a small angle, axes are not.
TEST(MapAlignment, WeighsPositionsAndAxes) {
  constexpr double kTurn = 0.01;
  const auto circle = [](double turn) {
    return make_trajectory(40, 0, 0.1, [turn](double t) {
      const double angle = 2 * 3.14159265358979 * t / 4 + turn;
      return make_pose(so3_exp({0, 0, 0}), {std::cos(angle), std::sin(angle), 0});
    });
  };
  const Eigen::Isometry3d T = *map_alignment(circle(kTurn), circle(0));
  // All 6 points of each pose are turned with the position, 1 m from the axis; 4 of them, of the
  // axes x and y, resist, 1 m from the position.
  EXPECT_NEAR(rotation_angle(T.linear()), kTurn * 6 / (6 + 4), 1e-6);
}

TEST(MapAlignment, NeedsThreePairs) {
  const auto still = [](double) { return Eigen::Isometry3d::Identity(); };
  const Trajectory two = make_trajectory(2, 1, 0.1, still);
  EXPECT_FALSE(map_alignment(two, two));
  EXPECT_FALSE(map_alignment({}, {}));
}

}  // namespace
}  // namespace stillmap
