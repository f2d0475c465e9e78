// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/system_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/system/system.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;

std::string complaint(const SystemConfig& config) {
  try {
    config.check();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(SystemConfig, DefaultsAgree) {
  EXPECT_EQ(complaint({}), "");
}

TEST(SystemConfig, RefusesMappingThatOutlastsTheGapBetweenKeyframes) {
  SystemConfig config;
  config.keyframe.min_gap_frames = 3;
  config.mapping.lag_frames = 3;
  EXPECT_EQ(complaint(config), "");
  config.mapping.lag_frames = 4;
  EXPECT_THAT(complaint(config), HasSubstr("keyframe.min_gap_frames"));
  EXPECT_THAT(complaint(config), HasSubstr("mapping.lag_frames"));
  EXPECT_THROW(System(config, builtin_camera("tum_fr3"), {.threads = 1}), Error);
}

TEST(SystemConfig, RefusesContradictions) {
  SystemConfig gaps;
  gaps.keyframe.max_gap_frames = gaps.keyframe.min_gap_frames - 1;
  EXPECT_THAT(complaint(gaps), HasSubstr("keyframe.max_gap_frames"));
  SystemConfig corners;
  corners.tracking.orb.weak_corner_threshold = corners.tracking.orb.corner_threshold + 1;
  EXPECT_THAT(complaint(corners), HasSubstr("tracking.weak_corner_threshold"));
}

}  // namespace
}  // namespace stillmap
