// SPDX-License-Identifier: Apache-2.0
#include "tooling/browser/message.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

std::string text_of(const std::vector<char>& bytes) {
  return {bytes.begin(), bytes.end()};
}

TEST(Message, IsLengthHeadAndBody) {
  Message message;
  EXPECT_TRUE(message.empty());
  const std::vector<std::uint8_t> bytes = {7, 8, 9};
  const std::vector<std::uint16_t> numbers = {0x1234, 5};
  EXPECT_EQ(message.attach(bytes), 0U);
  EXPECT_EQ(message.attach(numbers), 4U);  // the next multiple of 4
  message.add("a", "[1]");
  message.add("b", "\"x\"");
  const std::string expected_head = R"({"a":[1],"b":"x"})";  // 17 characters: three spaces follow
  const std::string expected =
      text_of({20, 0, 0, 0}) + expected_head + "   " + text_of({7, 8, 9, 0, 0x34, 0x12, 5, 0});
  EXPECT_EQ(message.bytes(), expected);
}

TEST(Message, WithoutBodyIsLengthAndHead) {
  Message message;
  message.add("more", "true");
  EXPECT_EQ(message.bytes(), text_of({16, 0, 0, 0}) + R"({"more":true}   )");
}

}  // namespace
}  // namespace stillmap
