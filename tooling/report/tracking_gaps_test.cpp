// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/tracking_gaps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stillmap {
namespace {

using testing::HasSubstr;

Stamp at(int second) {
  return {static_cast<double>(second), std::to_string(second) + ".0"};
}

// Poses at these seconds; x is as many decimetres.
Trajectory poses(const std::vector<int>& seconds) {
  Trajectory trajectory;
  for (const int second : seconds) {
    trajectory.push_back({at(second), Eigen::Isometry3d(Eigen::Translation3d(0.1 * second, 0, 0))});
  }
  return trajectory;
}

std::vector<Stamp> stamps(const std::vector<int>& seconds) {
  std::vector<Stamp> all;
  for (const int second : seconds) all.push_back(at(second));
  return all;
}

TEST(TrackingGaps, NoneWithoutLostFrames) {
  EXPECT_TRUE(tracking_gaps({}, poses({1, 2, 3})).empty());
  EXPECT_TRUE(tracking_gaps({}, {}).empty());
}

TEST(TrackingGaps, OfTheMiddleAndTheEnd) {
  // Frame 7 could not be read.
  const std::vector<TrackingGap> gaps =
      tracking_gaps(stamps({3, 4, 8, 11, 12}), poses({1, 2, 5, 6, 9, 10}));
  ASSERT_EQ(gaps.size(), 3U);
  EXPECT_EQ(gaps[0].first_lost.text, "3.0");
  EXPECT_EQ(gaps[0].frames, 2U);
  EXPECT_DOUBLE_EQ(gaps[0].seconds, 2);
  EXPECT_EQ(gaps[0].found->text, "5.0");
  EXPECT_NEAR(*gaps[0].moved_m, 0.3, 1e-12);  // from 0.2 to 0.5
  EXPECT_EQ(gaps[1].first_lost.text, "8.0");
  EXPECT_EQ(gaps[1].frames, 1U);
  EXPECT_NEAR(*gaps[1].moved_m, 0.3, 1e-12);  // from 0.6 to 0.9
  EXPECT_EQ(gaps[2].frames, 2U);
  EXPECT_DOUBLE_EQ(gaps[2].seconds, 1);
  EXPECT_FALSE(gaps[2].found);
  EXPECT_FALSE(gaps[2].moved_m);
}

TEST(TrackingGaps, BeforeTheFirstPoseNothingMoves) {
  const std::vector<TrackingGap> gaps = tracking_gaps(stamps({1, 2}), poses({3, 4}));
  ASSERT_EQ(gaps.size(), 1U);
  EXPECT_EQ(gaps[0].found->text, "3.0");
  EXPECT_FALSE(gaps[0].moved_m);
  EXPECT_THAT(gap_text(gaps[0]), HasSubstr("begun at 3.0"));
}

TEST(TrackingGaps, OfARunThatNeverBegan) {
  const std::vector<TrackingGap> gaps = tracking_gaps(stamps({1, 2, 3}), {});
  ASSERT_EQ(gaps.size(), 1U);
  EXPECT_EQ(gaps[0].frames, 3U);
  EXPECT_FALSE(gaps[0].found);
}

TEST(TrackingGaps, InWords) {
  const std::vector<TrackingGap> gaps = tracking_gaps(stamps({3, 6}), poses({1, 5}));
  ASSERT_EQ(gaps.size(), 2U);
  EXPECT_THAT(gap_text(gaps[0]), HasSubstr("1 frame from 3.0, "));
  EXPECT_THAT(gap_text(gaps[0]), HasSubstr("found again at 5.0, "));
  EXPECT_THAT(gap_text(gaps[1]), HasSubstr("not found again"));
}

}  // namespace
}  // namespace stillmap
