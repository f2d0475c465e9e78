// SPDX-License-Identifier: Apache-2.0
#include "tooling/view/inbox.hpp"

#include <gtest/gtest.h>

namespace stillmap {
namespace {

ViewedFrame frame_numbered(std::uint32_t number) {
  ViewedFrame frame;
  frame.number = number;
  return frame;
}

ViewedSample sample_numbered(std::uint32_t number) {
  ViewedSample sample;
  sample.first.id = FrameId(number);
  return sample;
}

TEST(ViewInbox, WakesItsReaderOnceUntilItHasRead) {
  ViewInbox inbox;
  EXPECT_TRUE(inbox.put_frame(frame_numbered(0), std::nullopt));
  EXPECT_FALSE(inbox.put_frame(frame_numbered(1), std::nullopt));
  EXPECT_FALSE(inbox.put_dropped(1));
  EXPECT_EQ(inbox.take().frames.size(), 2U);
  EXPECT_TRUE(inbox.put_dropped(1));
  const ViewInbox::Contents second = inbox.take();
  EXPECT_TRUE(second.frames.empty());
  EXPECT_EQ(second.dropped, 1U);
}

TEST(ViewInbox, KeepsTheNewestPictureAlone) {
  ViewInbox inbox;
  for (std::uint32_t i = 0; i < 100; ++i) inbox.put_frame(frame_numbered(i), sample_numbered(i));
  const ViewInbox::Contents contents = inbox.take();
  EXPECT_EQ(contents.newest->first.id, FrameId(99));
  EXPECT_EQ(contents.frames.size(), 100U);
  EXPECT_EQ(contents.left_out, 0U);
}

TEST(ViewInbox, IsBoundedAndTheNewestStay) {
  ViewInbox inbox;
  for (std::uint32_t i = 0; i < 20; ++i) inbox.put_for_map(sample_numbered(i));
  const auto all = static_cast<std::uint32_t>(ViewInbox::kFrames) + 5;
  for (std::uint32_t i = 0; i < all; ++i) inbox.put_frame(frame_numbered(i), std::nullopt);
  const ViewInbox::Contents contents = inbox.take();
  ASSERT_EQ(contents.for_map.size(), ViewInbox::kForMap);
  EXPECT_EQ(contents.for_map.front().first.id, FrameId(20 - ViewInbox::kForMap));
  EXPECT_EQ(contents.for_map.back().first.id, FrameId(19));
  ASSERT_EQ(contents.frames.size(), ViewInbox::kFrames);
  EXPECT_EQ(contents.frames.front().number, 5U);
  EXPECT_EQ(contents.left_out, 12U + 5U);
}

}  // namespace
}  // namespace stillmap
