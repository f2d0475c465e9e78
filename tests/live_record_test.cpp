// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/live_record.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/io/atomic_file.hpp"
#include "tests/support/live_runs.hpp"

namespace stillmap {
namespace {

LiveRecord read_text(const std::string& text) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "live.jsonl", text);
  return read_live_record(folder.path() / "live.jsonl", wall_sequence());
}

std::string refusal(const std::string& text) {
  return error_of([&] { (void)read_text(text); });
}

TEST(LiveRecord, IsReadAsWritten) {
  const LiveRecord record = {{FrameId(0), {FrameId(0)}},
                             {FrameId(2), {}},
                             {FrameId(3), {FrameId(2), FrameId(3)}},
                             {FrameId(29), {}}};
  const std::string text = live_jsonl(record, wall_sequence());
  EXPECT_EQ(read_text(text), record);
  EXPECT_EQ(text.substr(0, text.find('\n')),
            R"({"stamp":"100.000000","frame":0,"objects_of":[0]})");
}

TEST(LiveRecord, OfAnotherSequenceOrBrokenIsRefusedByLine) {
  const std::string first = R"({"frame":4,"objects_of":[]})"
                            "\n";
  const auto second = [&](const std::string& line) { return refusal(first + line + "\n"); };
  using testing::HasSubstr;
  EXPECT_THAT(refusal(""), HasSubstr("no frame in it"));
  EXPECT_THAT(second("nonsense"), HasSubstr("live.jsonl:2: expected {"));
  EXPECT_THAT(second("[1]"), HasSubstr(":2: expected {"));
  EXPECT_THAT(second(R"({"frame":5})"), HasSubstr(":2: expected {"));
  EXPECT_THAT(second(R"({"frame":30,"objects_of":[]})"), HasSubstr("from 0 to 29"));
  EXPECT_THAT(second(R"({"frame":-1,"objects_of":[]})"), HasSubstr("from 0 to 29"));
  EXPECT_THAT(second(R"({"frame":1e99,"objects_of":[]})"), HasSubstr("from 0 to 29"));
  EXPECT_THAT(second(R"({"frame":4,"objects_of":[]})"), HasSubstr("does not come after frame 4"));
  EXPECT_THAT(second(R"({"frame":6,"objects_of":[5]})"), HasSubstr("objects of frame 5"));
  EXPECT_THAT(second(R"({"frame":6,"objects_of":[7]})"), HasSubstr("objects of frame 7"));
  EXPECT_THAT(second(R"({"frame":6,"objects_of":[4,4]})"), HasSubstr("objects of frame 4"));
  EXPECT_THAT(second(R"({"frame":6,"objects_of":["x"]})"), HasSubstr("from 0 to 29"));
  EXPECT_THAT(second(R"({"stamp":"1.5","frame":6,"objects_of":[]})"),
              HasSubstr("frame 6 of this sequence has the stamp 100.200000"));
  EXPECT_THAT(refusal(first.substr(0, 9)), HasSubstr(":1: expected {"));
}

}  // namespace
}  // namespace stillmap
