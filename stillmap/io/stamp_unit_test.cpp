// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/stamp_unit.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

StampUnit guess(const std::vector<std::string>& texts) {
  std::vector<Stamp> stamps;
  for (const std::string& text : texts) stamps.push_back({std::stod(text), text});
  return guess_stamp_unit(stamps);
}

TEST(StampUnit, IsToldByStepAndSize) {
  const auto s = StampUnit::kSeconds, ms = StampUnit::kMilliseconds, us = StampUnit::kMicroseconds,
             ns = StampUnit::kNanoseconds, frames = StampUnit::kFrames;
  EXPECT_EQ(guess({"1305031102.175304", "1305031102.211214"}), s);       // TUM
  EXPECT_EQ(guess({"1403636579763555584", "1403636579813555456"}), ns);  // EuRoC
  EXPECT_EQ(guess({"1341846313592.026", "1341846313625.4"}), ms);
  EXPECT_EQ(guess({"1341846313592026", "1341846313625400"}), us);
  EXPECT_EQ(guess({"1341846313592026112"}), ns);  // by its size alone
  EXPECT_EQ(guess({"0.000000", "0.033333", "0.066667"}), s);
  EXPECT_EQ(guess({"0", "33", "67", "100"}), ms);
  EXPECT_EQ(guess({"0", "33333", "66667"}), us);
  EXPECT_EQ(guess({"33333333", "66666667", "100000000"}), ns);
  EXPECT_EQ(guess({"5000000000000", "5000033333333"}), ns);  // a clock since its machine's start
  EXPECT_EQ(guess({"1", "2", "3", "7"}), frames);            // ICL-NUIM
  EXPECT_EQ(guess({"0", "5", "10"}), frames);
  EXPECT_EQ(guess({"1.0", "2.0", "3.0"}), s);             // the point says seconds
  EXPECT_EQ(guess({"1305031102", "1305031103"}), s);      // an image every second
  EXPECT_EQ(guess({"1305031102.5", "1305031162.5"}), s);  // or every minute
  EXPECT_EQ(guess({"0", "0", "33", "33"}), ms);           // repeated stamps do not count
  EXPECT_EQ(guess({"67", "0", "33"}), ms);
  EXPECT_EQ(guess({"12"}), s);
  EXPECT_EQ(guess({}), s);
}

TEST(StampUnit, HasNamesAndALength) {
  EXPECT_EQ(stamp_unit_words(StampUnit::kFrames), "frame numbers");
  EXPECT_EQ(seconds_per(StampUnit::kFrames, 25), 0.04);
  EXPECT_EQ(seconds_per(StampUnit::kNanoseconds, 25), 1e-9);
  EXPECT_EQ(seconds_per(StampUnit::kSeconds, 25), 1.0);
  EXPECT_EQ(stamp_unit_by_size(1.7e12), StampUnit::kMilliseconds);
  EXPECT_EQ(stamp_unit_by_size(1.7e9), StampUnit::kSeconds);
  EXPECT_EQ(stamp_unit_by_size(4e9), StampUnit::kSeconds);  // no clock of today
}

}  // namespace
}  // namespace stillmap
