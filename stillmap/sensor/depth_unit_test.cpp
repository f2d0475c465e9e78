// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/depth_unit.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/io/image_io.hpp"
#include "stillmap/sensor/sequence.hpp"
#include "tests/support/shared_data.hpp"

namespace stillmap {
namespace {

// Depths from `near_m` to `far_m` in equal parts, in steps of `step` units.
DepthUnitEvidence evidence_of(double near_m, double far_m, double factor, int step = 1) {
  cv::Mat1f stored(100, 100);
  for (int i = 0; i < 10000; ++i) {
    const double value = (near_m + (far_m - near_m) * i / 9999) * factor;
    stored(i / 100, i % 100) = static_cast<float>(step * std::lround(value / step));
  }
  const std::vector<DepthImage> images = {DepthImage(stored)};
  return depth_unit_evidence(images);
}

TEST(DepthUnit, QuantilesAreThoseOfTheValues) {
  const DepthUnitEvidence evidence = evidence_of(1.0, 3.0, 1000);
  EXPECT_EQ(evidence.pixels, 10000U);
  EXPECT_NEAR(evidence.near, 1040, 1);
  EXPECT_NEAR(evidence.median, 2000, 1);
  EXPECT_NEAR(evidence.far, 2960, 1);
  EXPECT_FALSE(evidence.in_fives);
  EXPECT_TRUE(evidence_of(1.0, 3.0, 5000, 5).in_fives);
}

TEST(DepthUnit, OfARoomIsFound) {
  EXPECT_EQ(evidence_of(0.6, 3.5, 1000).depth_factor(), 1000.0);  // a desk and the wall behind
  EXPECT_EQ(evidence_of(0.3, 1.2, 1000).depth_factor(), 1000.0);  // a desk from nearby
  EXPECT_EQ(evidence_of(1.5, 9.0, 5000).depth_factor(), 5000.0);  // a hall
  EXPECT_EQ(evidence_of(0.8, 5.0, 5000).depth_factor(), 5000.0);  // a room
  EXPECT_EQ(evidence_of(0.5, 1.8, 5000, 5).depth_factor(), 5000.0);
}

TEST(DepthUnit, ThatIsUnclearIsNotGuessed) {
  // 2.5 to 9 m in millimetres, or 0.5 to 1.8 m in 1/5000 m.
  EXPECT_EQ(evidence_of(0.5, 1.8, 5000).depth_factor(), std::nullopt);
  EXPECT_EQ(evidence_of(0.6, 2.0, 100).depth_factor(), std::nullopt);  // neither
  EXPECT_EQ(depth_unit_evidence({}).depth_factor(), std::nullopt);
  const std::vector<DepthImage> empty = {DepthImage(cv::Mat1f(480, 640, 0.0F))};
  EXPECT_EQ(depth_unit_evidence(empty).depth_factor(), std::nullopt);
}

TEST(DepthUnitOnData, IsThatOfTum) {
  STILLMAP_NEED_SHARED_DATA("twin_walking_xyz");
  for (const char* name : {"tum_fr1_xyz_360", "fr1_xyz_walkers", "twin_walking_xyz"}) {
    const Sequence sequence = Sequence::open(shared_data(name));
    std::vector<DepthImage> stored;
    for (std::uint32_t i = 0; i < 5; ++i) {
      stored.push_back(read_depth(sequence.entry(FrameId(i)).depth_file, 1));
    }
    EXPECT_EQ(depth_unit_evidence(stored).depth_factor(), 5000.0) << name;
    // The same in millimetres.
    for (DepthImage& image : stored) {
      for (float& value : image.mat) value = std::round(value / 5);
    }
    EXPECT_EQ(depth_unit_evidence(stored).depth_factor(), 1000.0) << name;
  }
}

}  // namespace
}  // namespace stillmap
