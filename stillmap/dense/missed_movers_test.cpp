// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/missed_movers.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/feature_images.hpp"

namespace stillmap {
namespace {

constexpr double kFrame_s = 1.0 / 30;
constexpr double kSpeed_m_s = 1.2;

/// A grid of points, 0.4 m wide and 1.6 m high, that walks along x.
std::vector<Eigen::Vector3d> person_at(double stamp_s) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 16; ++j) {
      points.emplace_back(kSpeed_m_s * stamp_s + 0.05 * i, 0.1 * j, 2.0);
    }
  }
  return points;
}

/// Frames in which the person is seen, but for those from `first` to `last`.
MissedMovers seen_but(int first, int last, int frames) {
  MissedMovers missed({});
  for (int k = 0; k < frames; ++k) {
    const bool seen = k < first || k > last;
    const double stamp_s = k * kFrame_s;
    std::vector<MoverSighting> movers;
    if (seen) movers.push_back({TrackId(1), person_at(stamp_s)});
    missed.remember(stamp_s, std::move(movers));
  }
  return missed;
}

double farthest(const std::vector<Eigen::Vector3d>& truth,
                const std::vector<Eigen::Vector3d>& places) {
  double most = 0;
  for (const Eigen::Vector3d& p : truth) most = std::max(most, distance_to(places, p));
  return most;
}

TEST(MissedMovers, KnowsWhereAPersonIsInAGap) {
  const MissedMovers missed = seen_but(15, 27, 50);
  for (const int k : {15, 18, 21, 24, 27}) {
    const double stamp_s = k * kFrame_s;
    EXPECT_LT(farthest(person_at(stamp_s), missed.places_at(stamp_s)), 0.02) << k;
  }
}

TEST(MissedMovers, KnowsWhereAPersonWasBeforeAndAfter) {
  const MissedMovers before = seen_but(0, 9, 25), after = seen_but(15, 24, 25);
  EXPECT_LT(farthest(person_at(2 * kFrame_s), before.places_at(2 * kFrame_s)), 0.02);
  EXPECT_LT(farthest(person_at(22 * kFrame_s), after.places_at(22 * kFrame_s)), 0.02);
}

TEST(MissedMovers, SaysNothingOfThoseWhoAreSeenOrLongGoneOrHardlySeen) {
  EXPECT_TRUE(seen_but(15, 27, 50).places_at(10 * kFrame_s).empty()) << "seen in that frame";
  EXPECT_TRUE(seen_but(10, 60, 61).places_at(60 * kFrame_s).empty()) << "more than a second ago";
  EXPECT_TRUE(seen_but(2, 10, 11).places_at(5 * kFrame_s).empty()) << "seen twice";
  EXPECT_FALSE(seen_but(3, 10, 11).places_at(5 * kFrame_s).empty());
}

TEST(MissedMovers, PointsNearThePlacesAreLeftOut) {
  TestDice dice(3);
  const auto anywhere = [&] {
    return Eigen::Vector3f(dice.uniform(-2, 2), dice.uniform(-2, 2), dice.uniform(1, 4));
  };
  PointCloud cloud;
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < 4000; ++i) cloud.positions.push_back(anywhere());
  for (int i = 0; i < 30; ++i) places.push_back(anywhere().cast<double>());
  cloud.colors.resize(cloud.positions.size());
  cloud.labels.assign(cloud.positions.size(), 7);
  const StaticView view{compact(cloud), {}};
  const StaticView kept = without_places(view, places, 0.3);
  ASSERT_EQ(kept.cloud.colors.size(), kept.cloud.size());
  ASSERT_EQ(kept.cloud.labels.size(), kept.cloud.size());
  // Space is divided into cells of 5 cm: points nearly 0.3 m away may be kept or not.
  std::size_t sure = 0, possible = 0;
  for (std::size_t i = 0; i < view.cloud.size(); ++i) {
    const double distance = distance_to(places, view.cloud.position(i).cast<double>());
    sure += distance > 0.39 ? 1 : 0;
    possible += distance > 0.21 ? 1 : 0;
  }
  EXPECT_GE(kept.cloud.size(), sure);
  EXPECT_LE(kept.cloud.size(), possible);
  EXPECT_LT(possible, view.cloud.size());
  for (std::size_t i = 0; i < kept.cloud.size(); ++i) {
    EXPECT_GT(distance_to(places, kept.cloud.position(i).cast<double>()), 0.2);
  }
}

}  // namespace
}  // namespace stillmap
