// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/look_policy.hpp"

#include <gtest/gtest.h>

namespace stillmap {
namespace {

constexpr LiveConfig kConfig{.look_gap_frames = 3, .look_rest_frames = 10};

/// A frame of 100 x 100 pixels, some of which jump.
FrameResult frame(int jumping_pixels) {
  FrameResult result;
  cv::Mat1b jumps(100, 100, std::uint8_t{0});
  for (int i = 0; i < jumping_pixels; ++i) jumps(i / 100, i % 100) = 255;
  result.depth_jumps = Mask(jumps);
  return result;
}

FrameResult with_person(std::uint32_t track) {
  FrameResult result = frame(0);
  ObjectState person;
  person.dynamic = true;
  person.track = TrackId(track);
  result.objects = {person};
  return result;
}

TEST(LookPolicy, RestsWhileNothingMoves) {
  LookPolicy policy(kConfig, true);
  EXPECT_EQ(policy.gap_frames(), 3) << "nothing is known yet";
  policy.observe(frame(5));
  EXPECT_EQ(policy.gap_frames(), 10);
  policy.observe(with_person(1));
  policy.observe(with_person(1));
  EXPECT_EQ(policy.gap_frames(), 3) << "somebody sits there";
}

TEST(LookPolicy, LooksAtOnceWhenSomethingComes) {
  LookPolicy policy(kConfig, true);
  for (int i = 0; i < 5; ++i) policy.observe(frame(5));
  policy.observe(frame(80));
  EXPECT_EQ(policy.gap_frames(), 1);
  for (int i = 0; i < 20; ++i) policy.observe(frame(80));
  EXPECT_EQ(policy.gap_frames(), 3) << "it is not new any more";
}

TEST(LookPolicy, LooksAtOnceAgainWhenSomebodyIsSeenForTheFirstTime) {
  LookPolicy policy(kConfig, true);
  policy.observe(with_person(1));
  EXPECT_EQ(policy.gap_frames(), 1);
  policy.observe(with_person(1));
  EXPECT_EQ(policy.gap_frames(), 3);
  policy.observe(with_person(2));
  EXPECT_EQ(policy.gap_frames(), 1);
}

TEST(LookPolicy, DoesNotRestWhereNoJumpsAreFound) {
  LookPolicy policy(kConfig, false);
  policy.observe(frame(0));
  EXPECT_EQ(policy.gap_frames(), 3);
}

}  // namespace
}  // namespace stillmap
