// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/track.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

TEST(EasedTrack, HoldsItsKeysAndMovesBetween) {
  const EasedTrack track({{1.0, 2.0}, {3.0, 6.0}, {5.0, 6.0}});
  EXPECT_DOUBLE_EQ(track.at(-1.0), 2.0);
  EXPECT_DOUBLE_EQ(track.at(1.0), 2.0);
  EXPECT_DOUBLE_EQ(track.at(2.0), 4.0);  // eases are symmetrical
  EXPECT_DOUBLE_EQ(track.at(4.2), 6.0);
  EXPECT_DOUBLE_EQ(track.at(9.0), 6.0);
}

TEST(EasedTrack, HasNoVelocityAtItsKeys) {
  const EasedTrack track({{0.0, 0.0}, {1.0, 1.0}, {2.0, 0.0}});
  for (const double t : {0.0, 1.0, 2.0}) {
    EXPECT_NEAR(track.at(t + 1e-3) - track.at(t - 1e-3), 0.0, 1e-7) << t;
  }
}

TEST(FloorPath, PassesItsKeysWithoutJumpsOfVelocity) {
  const FloorPath path(
      {{0.0, 0.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {2.5, 1.0, 2.0}, {3.0, 0.5, 2.0, 3.0}});
  EXPECT_NEAR((path.at(1.0).position - Eigen::Vector2d(1.0, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((path.at(7.0).position - Eigen::Vector2d(0.5, 2.0)).norm(), 0.0, 1e-12);
  constexpr double kStep = 1e-6;
  for (const double t : {0.0, 1.0, 2.5, 3.0}) {
    const Eigen::Vector2d before = (path.at(t).position - path.at(t - kStep).position) / kStep;
    const Eigen::Vector2d after = (path.at(t + kStep).position - path.at(t).position) / kStep;
    EXPECT_NEAR((before - after).norm(), 0.0, 1e-4) << t;
  }
}

TEST(FloorPath, FacesWhereItGoesWhereNothingElseIsSaid) {
  // Symmetrical about the second key, so the velocity there is along y.
  const FloorPath path({{0.0, 0.0, -1.0, 0.0}, {1.0, 1.0, 0.0}, {2.0, 0.0, 1.0, 3.0}});
  EXPECT_NEAR(path.at(1.0).yaw, std::numbers::pi / 2, 1e-12);
}

TEST(FloorPath, TurnsOnTheSpotAtKeysThatStop) {
  const FloorPath path({{0.0, 0.0, 0.0, 0.0},
                        {1.0, 1.0, 0.0, 0.0, true},
                        {2.0, 1.0, 0.0, 2.0, true},
                        {3.0, 1.0, 1.0, 2.0}});
  for (double t = 1.0; t < 2.0; t += 0.1) {
    EXPECT_NEAR((path.at(t).position - Eigen::Vector2d(1.0, 0.0)).norm(), 0.0, 1e-12);
  }
  EXPECT_NEAR(path.at(1.5).yaw, 1.0, 1e-12);
}

}  // namespace
}  // namespace stillmap
