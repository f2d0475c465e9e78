// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/compact_cloud.hpp"

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "tests/support/brute_force_thinning.hpp"

namespace stillmap {
namespace {

TEST(CompactCloud, KeepsPositionsToHalfAStep) {
  PointCloud cloud = random_cloud(20000, 3.0, 5);
  for (Eigen::Vector3f& p : cloud.positions) p += Eigen::Vector3f(1, -2, 4);
  const CompactCloud small = compact(cloud);
  ASSERT_EQ(small.size(), cloud.size());
  float greatest = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    greatest = std::max(greatest, (small.position(i) - cloud.positions[i]).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(greatest, 6.0F / 65535 / 2 + 1e-6F);  // from -3 to 3 m
  EXPECT_GT(greatest, 0);
  EXPECT_EQ(small.colors, cloud.colors);
  EXPECT_EQ(small.labels, cloud.labels);
}

TEST(CompactCloud, TheEndsAreWhereTheyWere) {
  PointCloud cloud;
  cloud.positions = {{-1, 2, 0.5F}, {3, 2, 0.25F}, {1, 2, 6}};
  cloud.colors.resize(3);
  const CompactCloud small = compact(cloud);
  EXPECT_EQ(small.places[0], (std::array<std::uint16_t, 3>{0, 0, 2849}));  // 0.25 / 5.75 * 65535
  EXPECT_EQ(small.places[1], (std::array<std::uint16_t, 3>{65535, 0, 0}));
  EXPECT_EQ(small.places[2], (std::array<std::uint16_t, 3>{32768, 0, 65535}));
  EXPECT_TRUE(small.position(1).isApprox(cloud.positions[1], 1e-6F));
  EXPECT_EQ(small.position(0).y(), 2);
  EXPECT_TRUE(small.labels.empty());
}

TEST(CompactCloud, OfNothingIsEmptyAndOfNoNumberRefused) {
  EXPECT_TRUE(compact({}).empty());
  PointCloud cloud;
  cloud.positions = {{0, 0, std::numeric_limits<float>::quiet_NaN()}};
  cloud.colors.resize(1);
  EXPECT_THROW((void)compact(cloud), InternalError);
}

}  // namespace
}  // namespace stillmap
