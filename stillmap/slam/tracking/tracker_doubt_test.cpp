// SPDX-License-Identifier: Apache-2.0
// Doubted features: requested when the others are too few, used when the others agree.
#include <algorithm>

#include <gtest/gtest.h>

#include "stillmap/slam/features/feature_selection.hpp"
#include "stillmap/slam/tracking/tracker.hpp"
#include "tests/support/simulated_walk.hpp"

namespace stillmap {
namespace {

/// Each `every`th feature, or all others.
Features part_of(const Features& features, std::size_t every, bool others) {
  std::vector<std::uint8_t> keep(features.size());
  for (std::size_t i = 0; i < keep.size(); ++i) keep[i] = (i % every == 0) != others ? 1 : 0;
  return select_features(features, keep, simulated_camera());
}

Features moved(Features features) {
  for (Eigen::Vector2f& px : features.ideal_px) px.x() += 12.0F;
  features.px = features.ideal_px;
  return features;
}

TEST(Tracker, UsesDoubtedFeaturesWhereTheOthersAreTooFew) {
  constexpr std::size_t kEvery = 50;  // leaves less than min_inliers
  for (const bool may : {true, false}) {
    SimulatedWalk walk(path, {});
    int tracked = 0;
    for (int k = 1; k <= 30; ++k) {
      const Features seen = walk.observe(k, kWalkNoise).features;
      const MoreFeatures more = [&](const Features& own) -> std::optional<Features> {
        Features doubted = part_of(seen, kEvery, true);
        doubted.trust.assign(doubted.size(), 0.3F);
        return joined_features(own, doubted, simulated_camera());
      };
      const TrackedFrame frame =
          walk.track(k, part_of(seen, kEvery, false), may ? more : MoreFeatures{});
      if (!has_pose(frame)) continue;
      ++tracked;
      EXPECT_LT(walk.error_m(frame), 0.015) << k;
    }
    EXPECT_EQ(tracked, may ? 30 : 0);
  }
}

// All doubted features have moved by the same 12 pixels, as on a person who fills the image.
TEST(Tracker, TakesNoPoseThatTheTrustedFeaturesContradict) {
  std::vector<double> worst;
  for (const double confirmed_share : {TrackerConfig{}.confirmed_share, 0.0}) {
    TrackerConfig config = {};
    config.confirmed_share = confirmed_share;
    SimulatedWalk walk(path, config);
    double worst_m = 0;
    for (int k = 1; k <= 30; ++k) {
      const Features seen = walk.observe(k, kWalkNoise).features;
      const MoreFeatures more = [&](const Features& own) -> std::optional<Features> {
        Features doubted = moved(part_of(seen, 5, true));
        doubted.trust.assign(doubted.size(), 1.0F);
        return joined_features(own, doubted, simulated_camera());
      };
      const TrackedFrame frame = walk.track(k, part_of(seen, 5, false), more);
      ASSERT_TRUE(has_pose(frame)) << k;
      worst_m = std::max(worst_m, walk.error_m(frame));
    }
    worst.push_back(worst_m);
  }
  EXPECT_LT(worst[0], 0.012);
  EXPECT_GT(worst[1], 1.5 * worst[0]) << "what moves was not taken for the room";
}

// Few features are trusted, and they are wrong, as on somebody whom the network missed; the others
// are right, as on what it mistook for people.
TEST(Tracker, FewTrustedFeaturesYieldToManyInWhichThereIsTrust) {
  constexpr std::size_t kEvery = 25;  // leaves less than min_inliers, but enough to begin with
  SimulatedWalk walk(path, {});
  for (int k = 1; k <= 30; ++k) {
    const Features seen = walk.observe(k, kWalkNoise).features;
    const MoreFeatures more = [&](const Features& own) -> std::optional<Features> {
      Features doubted = part_of(seen, kEvery, true);
      doubted.trust.assign(doubted.size(), 0.8F);
      return joined_features(own, doubted, simulated_camera());
    };
    const TrackedFrame frame = walk.track(k, moved(part_of(seen, kEvery, false)), more);
    ASSERT_TRUE(has_pose(frame)) << k;
    EXPECT_LT(walk.error_m(frame), 0.015) << k;
  }
}

}  // namespace
}  // namespace stillmap
