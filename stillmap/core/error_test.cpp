// SPDX-License-Identifier: Apache-2.0
#include "stillmap/core/error.hpp"

#include <string>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

TEST(Error, IsOneLineWhateverItQuotes) {
  const std::string quoted("a\nb\r\0c\x7F\td \xC3\xA4", 12);
  EXPECT_EQ(std::string(Error("key.yaml:3: '{}'", quoted).what()),
            "key.yaml:3: 'a b  c  d \xC3\xA4'");
  EXPECT_EQ(std::string(Error(quoted).what()), "a b  c  d \xC3\xA4");
  EXPECT_EQ(std::string(Error("nothing quoted").what()), "nothing quoted");
}

}  // namespace
}  // namespace stillmap
