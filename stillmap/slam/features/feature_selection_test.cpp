// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/feature_selection.hpp"

#include <gtest/gtest.h>

namespace stillmap {
namespace {

Features three_features() {
  Features features;
  for (int i = 0; i < 3; ++i) {
    const auto x = static_cast<float>(100 * (i + 1));
    features.raw_px.emplace_back(x, 10.0F);
    features.ideal_px.emplace_back(x, 20.0F);
    features.px.emplace_back(x, 30.0F);
    features.sensor_depth_m.push_back(x / 100);
    features.depth_m.push_back(x / 50);
    features.level.push_back(static_cast<std::uint8_t>(i));
    features.angle_deg.push_back(x / 10);
    features.descriptors.push_back({static_cast<std::uint64_t>(i), 0, 0, 0});
  }
  return features;
}

TEST(FeatureSelection, KeepsWhatIsChosenInOrderWithAllItsParts) {
  const std::vector<std::uint8_t> keep = {1, 0, 1};
  const Features kept = select_features(three_features(), keep, builtin_camera("tum_fr3"));
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept.raw_px[1], Eigen::Vector2f(300, 10));
  EXPECT_EQ(kept.ideal_px[1], Eigen::Vector2f(300, 20));
  EXPECT_EQ(kept.px[1], Eigen::Vector2f(300, 30));
  EXPECT_EQ(kept.sensor_depth_m[1], 3.0F);
  EXPECT_EQ(kept.depth_m[1], 6.0F);
  EXPECT_EQ(kept.level[1], 2);
  EXPECT_EQ(kept.angle_deg[1], 30.0F);
  EXPECT_EQ(kept.descriptors[1][0], 2U);
}

TEST(FeatureSelection, TheGridFindsThemUnderTheirNewNumbers) {
  const std::vector<std::uint8_t> keep = {0, 0, 1};
  const Features kept = select_features(three_features(), keep, builtin_camera("tum_fr3"));
  std::vector<std::uint32_t> near;
  kept.grid.visit_near({300, 30}, 5, [&](std::uint32_t i) { near.push_back(i); });
  EXPECT_EQ(near, std::vector<std::uint32_t>{0});
}

TEST(FeatureSelection, NoneMayBeChosen) {
  const std::vector<std::uint8_t> keep = {0, 0, 0};
  EXPECT_EQ(select_features(three_features(), keep, builtin_camera("tum_fr3")).size(), 0U);
}

TEST(JoinedFeatures, AreThoseOfBothWithTheirTrust) {
  Features doubted = three_features();
  doubted.trust = {0.1F, 0.2F, 0.3F};
  const Features all = joined_features(three_features(), doubted, builtin_camera("tum_fr3"));
  ASSERT_EQ(all.size(), 6U);
  EXPECT_EQ(all.trust, (std::vector<float>{1, 1, 1, 0.1F, 0.2F, 0.3F}));
  EXPECT_EQ(all.raw_px[5], Eigen::Vector2f(300, 10));
  EXPECT_EQ(all.descriptors[4][0], 1U);
  std::vector<std::uint32_t> near;
  all.grid.visit_near({300, 30}, 5, [&](std::uint32_t i) { near.push_back(i); });
  EXPECT_EQ(near, (std::vector<std::uint32_t>{2, 5}));
}

}  // namespace
}  // namespace stillmap
