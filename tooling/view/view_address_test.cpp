// SPDX-License-Identifier: Apache-2.0
#include "tooling/view/view_address.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

TEST(ViewAddress, IsHostAndPort) {
  const ViewAddress address = parse_view_address("192.168.1.5:8080");
  EXPECT_EQ(address.host, "192.168.1.5");
  EXPECT_EQ(address.port, 8080);
  EXPECT_EQ(address.token, "");
  EXPECT_EQ(parse_view_address("localhost:0").host, "127.0.0.1");
  EXPECT_EQ(parse_view_address("[::1]:80").host, "::1");
}

TEST(ViewAddress, MayHaveAToken) {
  EXPECT_EQ(parse_view_address("127.0.0.1:80/abcdefgh-IJKL_0123").token, "abcdefgh-IJKL_0123");
}

TEST(ViewAddress, RefusesOtherTexts) {
  for (const char* text : {"",
                           "8080",
                           "127.0.0.1",
                           "127.0.0.1:",
                           "127.0.0.1:80x",
                           "127.0.0.1:65536",
                           "127.0.0.1:-1",
                           "example.com:80",
                           ":80",
                           "127.0.0.1:80/",
                           "127.0.0.1:80/short",
                           "127.0.0.1:80/sixteen characters",
                           "127.0.0.1:80/../../../../../../etc/x"}) {
    try {
      (void)parse_view_address(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::StartsWith(std::string(text) + ": expected HOST:PORT"));
    }
  }
}

TEST(RandomToken, IsAnotherEachTime) {
  const std::string token = random_token();
  EXPECT_THAT(token, testing::MatchesRegex("[0-9a-f]{32}"));
  EXPECT_NE(token, random_token());
}

TEST(SameToken, ComparesAllOfIt) {
  EXPECT_TRUE(same_token("abc", "abc"));
  EXPECT_FALSE(same_token("abc", "abd"));
  EXPECT_FALSE(same_token("abc", "xbc"));
  EXPECT_FALSE(same_token("abc", "ab"));
  EXPECT_FALSE(same_token("", "a"));
}

}  // namespace
}  // namespace stillmap
