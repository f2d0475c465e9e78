// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/page_text.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

std::string base64_of(std::string_view text) {
  return base64(std::vector<std::uint8_t>(text.begin(), text.end()));
}

TEST(HtmlEscape, MarkupBecomesText) {
  EXPECT_EQ(html_escape("<a href=\"x\">'&amp;'</a>"),
            "&lt;a href=&quot;x&quot;&gt;&#39;&amp;amp;&#39;&lt;/a&gt;");
}

TEST(HtmlEscape, KeepsUtf8LinesAndTabs) {
  const std::string text = "B\xC3\xBCro\n\t\xE6\x9C\xBA \xF0\x9F\x98\x80";
  EXPECT_EQ(html_escape(text), text);
}

TEST(HtmlEscape, ReplacesWhatIsNotText) {
  EXPECT_EQ(html_escape("a\xFFz"), "a\xEF\xBF\xBDz");
  EXPECT_EQ(html_escape("\xC0\xBC"), "\xEF\xBF\xBD\xEF\xBF\xBD");                  // '<', overlong
  EXPECT_EQ(html_escape("\xED\xA0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");  // a surrogate
  EXPECT_EQ(html_escape("\xE6\x9C"), "\xEF\xBF\xBD\xEF\xBF\xBD");                  // cut off
  EXPECT_EQ(html_escape("\xE6<"), "\xEF\xBF\xBD&lt;");
  EXPECT_EQ(html_escape(std::string_view("\0\x1b\x7f", 3)), "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST(Base64, VectorsOfTheRfc) {
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foob"), "Zm9vYg==");
  EXPECT_EQ(base64_of("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64_of("\xfb\xff\xfe"), "+//+");
}

TEST(FillTemplate, ValuesAreNotSearchedAgain) {
  EXPECT_EQ(fill_template("<{{a}}|{{b}}|{{a}}>", {{"a", "{{b}}"}, {"b", "2"}}), "<{{b}}|2|{{b}}>");
  EXPECT_EQ(fill_template("plain } {", {}), "plain } {");
  EXPECT_THROW(fill_template("{{missing}}", {}), InternalError);
}

}  // namespace
}  // namespace stillmap
