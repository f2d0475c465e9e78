// SPDX-License-Identifier: Apache-2.0
#include "stillmap/concurrency/channel.hpp"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

TEST(Channel, KeepsOrderThroughABoundedQueue) {
  Channel<int> channel(2);
  std::jthread producer([&] {
    for (int i = 0; i < 1000; ++i) ASSERT_TRUE(channel.push(i));
    channel.close();
  });
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(channel.pop(), i);
  EXPECT_EQ(channel.pop(), std::nullopt);
}

TEST(Channel, HandsTheProducersFailureOnAfterItsElements) {
  Channel<int> channel(4);
  ASSERT_TRUE(channel.push(7));
  channel.fail(std::make_exception_ptr(Error("broken")));
  EXPECT_EQ(channel.pop(), 7);
  EXPECT_THROW((void)channel.pop(), Error);
}

TEST(Channel, CancelReleasesAWaitingProducer) {
  Channel<int> channel(1);
  ASSERT_TRUE(channel.push(1));
  bool pushed = true;
  {
    std::jthread producer([&] { pushed = channel.push(2); });
    channel.cancel();
  }
  EXPECT_FALSE(pushed);
}

TEST(Channel, CancelDropsWhatIsStillQueued) {
  Channel<int> channel(4);
  ASSERT_TRUE(channel.push(1));
  channel.cancel();
  channel.close();
  EXPECT_EQ(channel.pop(), std::nullopt);
}

}  // namespace
}  // namespace stillmap
