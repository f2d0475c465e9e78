// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/tracking/motion_model.hpp"

#include <gtest/gtest.h>

namespace stillmap {
namespace {

// In a tenth of a second 2 cm along x, 1 cm down, 0.03 rad about y.
Eigen::Isometry3d tenth() {
  return make_pose(so3_exp(Eigen::Vector3d(0, 0.03, 0)), Eigen::Vector3d(0.02, 0.01, 0));
}

void expect_motion(const Eigen::Isometry3d& T, const Eigen::Vector3d& translation, double turn_y) {
  EXPECT_LT((T.translation() - translation).norm(), 1e-12);
  const Eigen::Vector3d turn = so3_log(Eigen::Quaterniond(T.linear()));
  EXPECT_LT((turn - Eigen::Vector3d(0, turn_y, 0)).norm(), 1e-12);
}

TEST(MotionModel, GoesOnInProportionToTheTime) {
  MotionModel model;
  model.set(tenth(), 0.1);
  expect_motion(model.predict(0.1), {0.02, 0.01, 0}, 0.03);
  expect_motion(model.predict(0.05), {0.01, 0.005, 0}, 0.015);
  expect_motion(model.predict(0.2), {0.04, 0.02, 0}, 0.06);
}

TEST(MotionModel, BridgesAGapForThreeFramesLengthOnly) {
  MotionModel model;
  model.set(tenth(), 0.1);
  expect_motion(model.predict(0.3), {0.06, 0.03, 0}, 0.09);
  expect_motion(model.predict(5.0), {0.06, 0.03, 0}, 0.09);
  expect_motion(model.predict(-1.0), {0, 0, 0}, 0);
}

TEST(MotionModel, ExpectsNoMotionWhileNothingIsKnown) {
  MotionModel model;
  expect_motion(model.predict(0.1), {0, 0, 0}, 0);
  model.set(tenth(), 0.1);
  model.reset();
  expect_motion(model.predict(0.1), {0, 0, 0}, 0);
  model.set(tenth(), 0.0);  // two frames with one stamp
  expect_motion(model.predict(0.1), {0, 0, 0}, 0);
}

}  // namespace
}  // namespace stillmap
