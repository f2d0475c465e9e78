// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/stamps.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/io/stamp_text.hpp"

namespace stillmap {
namespace {

std::optional<std::vector<Stamp>> numbers(const std::vector<std::string>& files) {
  return numbers_in_names(std::vector<std::filesystem::path>(files.begin(), files.end()));
}

TEST(NumbersInNames, AreTheLastOfEachName) {
  const auto found = numbers({"a/scene-7_0123.25.png", "9/frame000012.jpg"});
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ((*found)[0].seconds, 123.25);
  EXPECT_EQ((*found)[0].text, "0123.25");
  EXPECT_EQ((*found)[1].seconds, 12);
  EXPECT_FALSE(numbers({"1.png", "none.png"}).has_value());
}

TEST(NumbersInNames, AreStampsThatOtherFilesMayHave) {
  const std::string longest(kMaxStampLength, '6');
  EXPECT_TRUE(numbers({longest}).has_value());
  EXPECT_FALSE(numbers({longest + '6'}).has_value());
}

}  // namespace
}  // namespace stillmap
