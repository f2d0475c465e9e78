// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/display_text.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

const char* const kEnDash = "\xE2\x80\x93";

TEST(DisplayText, UnitsFitTheSize) {
  EXPECT_EQ(length_text(0.002134), "2.13\u00A0mm");
  EXPECT_EQ(length_text(0.0124), "1.24\u00A0cm");
  EXPECT_EQ(length_text(0.99), "99.0\u00A0cm");
  EXPECT_EQ(length_text(1.052), "1.05\u00A0m");
  EXPECT_EQ(length_text(123.4), "123\u00A0m");
  EXPECT_EQ(length_text(0), "0.00\u00A0mm");
  EXPECT_EQ(duration_text(0.512), "0.51\u00A0ms");
  EXPECT_EQ(duration_text(12.34), "12.3\u00A0ms");
  EXPECT_EQ(duration_text(1250), "1.25\u00A0s");
  EXPECT_EQ(memory_text(411.6), "412\u00A0MB");
  EXPECT_EQ(memory_text(1350), "1.35\u00A0GB");
}

TEST(DisplayText, WhatIsNotFiniteIsADash) {
  EXPECT_EQ(length_text(std::numeric_limits<double>::quiet_NaN()), kEnDash);
  EXPECT_EQ(duration_text(std::numeric_limits<double>::infinity()), kEnDash);
  EXPECT_EQ(memory_text(std::numeric_limits<double>::quiet_NaN()), kEnDash);
}

TEST(DisplayText, CountsHaveGroupsOfThree) {
  EXPECT_EQ(count_text(0), "0");
  EXPECT_EQ(count_text(999), "999");
  EXPECT_EQ(count_text(1000), "1,000");
  EXPECT_EQ(count_text(1234567), "1,234,567");
}

TEST(DisplayText, OnlyAllIsAHundredPercent) {
  EXPECT_EQ(share_text(360, 360), "100\u00A0%");
  EXPECT_EQ(share_text(9999, 10000), "99.9\u00A0%");
  EXPECT_EQ(share_text(1, 3), "33.3\u00A0%");
  EXPECT_EQ(share_text(0, 5), "0.0\u00A0%");
  EXPECT_EQ(share_text(0, 0), kEnDash);
}

}  // namespace
}  // namespace stillmap
