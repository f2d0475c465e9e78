// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/stamp_text.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

TEST(ParseStamp, TakesEveryDecimalNotation) {
  const std::vector<std::pair<std::string, double>> stamps = {
      {"1341846313.592026", 1341846313.592026},
      {"-0.5", -0.5},
      {"12.", 12},
      {".25", 0.25},
      {"1.5e9", 1.5e9},
      {"1E-3", 1e-3},
      {"007", 7}};
  for (const auto& [text, seconds] : stamps) {
    const std::optional<Stamp> stamp = parse_stamp(text);
    ASSERT_TRUE(stamp) << text;
    EXPECT_EQ(stamp->seconds, seconds) << text;
    EXPECT_EQ(stamp->text, text);
  }
}

TEST(ParseStamp, RefusesAllElse) {
  for (const char* text : {"",
                           ".",
                           "-",
                           "+1",
                           " 1",
                           "1 ",
                           "1,5",
                           "0x10",
                           "nan",
                           "inf",
                           "-inf",
                           "1e999",
                           "1.2.3",
                           "../1",
                           "1/2",
                           "1e",
                           "e5",
                           "1_000",
                           "\xD9\xA1"}) {
    EXPECT_FALSE(parse_stamp(text)) << text;
  }
  EXPECT_FALSE(parse_stamp(std::string_view("1\0", 2)));
  EXPECT_TRUE(parse_stamp(std::string(kMaxStampLength, '7')));
  EXPECT_FALSE(parse_stamp(std::string(kMaxStampLength + 1, '7')));
}

// Of a stamp that was read, and of one that no file gave.
TEST(StampText, IsReadAgain) {
  std::mt19937_64 rng(5);
  std::uniform_real_distribution<double> exponent(-30, 300);
  for (int i = 0; i < 20000; ++i) {
    const double seconds = (rng() % 2 == 0 ? 1 : -1) * std::pow(10.0, exponent(rng));
    const std::optional<Stamp> made = parse_stamp(stamp_text({seconds, ""}));
    ASSERT_TRUE(made) << seconds;
    EXPECT_NEAR(made->seconds, seconds, 5e-7 + 1e-15 * std::abs(seconds));
    std::ostringstream text;
    text.precision(17);
    text << (i % 3 == 0   ? std::fixed
             : i % 3 == 1 ? std::scientific
                          : std::defaultfloat)
         << std::fmod(seconds, 1e30);
    const std::optional<Stamp> read = parse_stamp(text.str());
    ASSERT_TRUE(read) << text.str();
    EXPECT_EQ(read->seconds, std::stod(text.str()));
    EXPECT_EQ(stamp_text(*read), text.str());
  }
}

}  // namespace
}  // namespace stillmap
