// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/cloud_stage.hpp"

#include <gtest/gtest.h>

#include "stillmap/core/camera.hpp"

namespace stillmap {
namespace {

TEST(CloudConfig, TheModeDecidesWhatIsLeftToIt) {
  const CloudConfig config;
  EXPECT_EQ(config.decided("off").depth.edges, "off");
  EXPECT_EQ(config.decided("off").depth.islands, "off");
  EXPECT_EQ(config.decided("mask").depth.edges, "off");
  EXPECT_EQ(config.decided("mask").depth.islands, "off");
  EXPECT_EQ(config.decided("paper").depth.edges, "fixed");
  EXPECT_EQ(config.decided("paper").depth.islands, "on");
  EXPECT_EQ(config.decided("full").depth.edges, "growing");
  EXPECT_EQ(config.decided("full").depth.islands, "on");

  CloudConfig own;
  own.depth.edges = "off";
  own.depth.islands = "off";
  EXPECT_EQ(own.decided("full").depth.edges, "off");
  EXPECT_EQ(own.decided("paper").depth.islands, "off");
}

}  // namespace
}  // namespace stillmap
