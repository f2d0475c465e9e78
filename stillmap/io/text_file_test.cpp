// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/text_file.hpp"

#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/io/atomic_file.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

std::string text_from(std::string_view bytes) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "t.txt", bytes);
  return read_text(folder.path() / "t.txt", 1000);
}

TEST(ReadText, DropsTheMarkAndConvertsUtf16) {
  using namespace std::string_view_literals;
  EXPECT_EQ(text_from("1.0 a\r\n"), "1.0 a\r\n");
  EXPECT_EQ(text_from(""), "");
  EXPECT_EQ(text_from("\xEF\xBB\xBF"
                      "1 a"),
            "1 a");
  EXPECT_EQ(text_from("\xFF\xFE\x31\x00\x0A\x00"sv), "1\n");
  EXPECT_EQ(text_from("\xFE\xFF\x00\x31\x00\x0A"sv), "1\n");
  // Two, three and four bytes in UTF-8: the letter e with an acute accent, the euro, a musical
  // clef.
  EXPECT_EQ(text_from("\xFF\xFE\xE9\x00\xAC\x20\x34\xD8\x1E\xDD"sv),
            "\xC3\xA9\xE2\x82\xAC\xF0\x9D\x84\x9E");
}

TEST(ReadText, RefusesHalvesOfUtf16) {
  using namespace std::string_view_literals;
  for (const std::string_view bytes : {"\xFF\xFE\x31"sv,
                                       "\xFF\xFE\x34\xD8"sv,
                                       "\xFF\xFE\x34\xD8\x31\x00"sv,
                                       "\xFF\xFE\x1E\xDD"sv}) {
    EXPECT_THAT(error_of([&] { (void)text_from(bytes); }),
                testing::HasSubstr("t.txt: broken UTF-16"));
  }
}

}  // namespace
}  // namespace stillmap
