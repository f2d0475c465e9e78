// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/measurement_model.hpp"

#include <gtest/gtest.h>

namespace stillmap {
namespace {

Features one_feature(float depth_m, std::uint8_t level) {
  Features features;
  features.px = {{12.5F, 30.25F}};
  features.ideal_px = features.raw_px = {{1.0F, 2.0F}};
  features.depth_m = {depth_m};
  features.sensor_depth_m = {7.0F};
  features.level = {level};
  return features;
}

const MeasurementModel kModel(
    {.pixel_sigma_px = 0.5, .inverse_depth_sigma = 0.02, .max_depth_m = 4}, {1.0F, 1.5F, 2.25F});

TEST(MeasurementModel, TakesThePositionAtTheFramesInstantAndScalesItsSigmaByTheLevel) {
  const PointMeasurement m = kModel(one_feature(2.0F, 2), 0);
  EXPECT_EQ(m.px, Eigen::Vector2d(12.5, 30.25));
  EXPECT_DOUBLE_EQ(m.pixel_weight, 1.0 / (0.5 * 2.25));
  EXPECT_DOUBLE_EQ(m.inverse_depth, 0.5);
  EXPECT_DOUBLE_EQ(m.inverse_depth_weight, 50.0);
}

TEST(MeasurementModel, MissingOrFarDepthIsLeftOut) {
  for (const float depth : {0.0F, -1.0F, 4.01F, std::numeric_limits<float>::quiet_NaN()}) {
    const Features features = one_feature(depth, 0);
    EXPECT_FALSE(kModel.has_depth(features, 0)) << depth;
    EXPECT_FALSE(kModel(features, 0).has_depth()) << depth;
    EXPECT_EQ(kModel(features, 0).inverse_depth, 0.0) << depth;
  }
  EXPECT_TRUE(kModel.has_depth(one_feature(4.0F, 0), 0));
}

}  // namespace
}  // namespace stillmap
