// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/live_record.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/io/atomic_file.hpp"
#include "tests/support/live_runs.hpp"
#include "tooling/pipeline/replayed_stream.hpp"

namespace stillmap {
namespace {

LiveRecord read_text(const std::string& text) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "live.jsonl", text);
  return read_live_record(folder.path() / "live.jsonl");
}

std::string refusal(const std::string& text) {
  return error_of([&] { (void)read_text(text); });
}

TEST(LiveRecord, IsReadAsWritten) {
  const LiveRecord record = {{FrameId(0), {FrameId(0)}, "100.000000"},
                             {FrameId(2), {}, "100.066667"},
                             {FrameId(3), {FrameId(2), FrameId(3)}, "100.100000"},
                             {FrameId(29), {}, "100.966667"}};
  const std::string text = live_jsonl(record);
  EXPECT_EQ(read_text(text), record);
  EXPECT_EQ(text.substr(0, text.find('\n')),
            R"({"stamp":"100.000000","frame":0,"objects_of":[0]})");
}

TEST(LiveRecord, MayLackStamps) {
  EXPECT_EQ(read_text(R"({"objects_of":[],"frame":4})"
                      "\n"),
            (LiveRecord{{FrameId(4), {}}}));
}

TEST(LiveRecord, ThatIsBrokenIsRefusedByLine) {
  const std::string first = R"({"frame":4,"objects_of":[]})"
                            "\n";
  const auto second = [&](const std::string& line) { return refusal(first + line + "\n"); };
  using testing::HasSubstr;
  EXPECT_THAT(refusal(""), HasSubstr("no frame in it"));
  EXPECT_THAT(second("nonsense"), HasSubstr("live.jsonl:2: expected {"));
  EXPECT_THAT(second("[1]"), HasSubstr(":2: expected {"));
  EXPECT_THAT(second(R"({"frame":5})"), HasSubstr(":2: expected {"));
  EXPECT_THAT(second(R"({"frame":-1,"objects_of":[]})"),
              HasSubstr(":2: a frame that is no number from 0"));
  EXPECT_THAT(second(R"({"frame":1e99,"objects_of":[]})"),
              HasSubstr(":2: a frame that is no number from 0"));
  EXPECT_THAT(second(R"({"frame":4,"objects_of":[]})"), HasSubstr("does not come after frame 4"));
  EXPECT_THAT(second(R"({"frame":6,"objects_of":[5]})"), HasSubstr("objects of frame 5"));
  EXPECT_THAT(second(R"({"frame":6,"objects_of":[7]})"), HasSubstr("objects of frame 7"));
  EXPECT_THAT(second(R"({"frame":6,"objects_of":[4,4]})"), HasSubstr("objects of frame 4"));
  EXPECT_THAT(second(R"({"frame":6,"objects_of":["x"]})"),
              HasSubstr(":2: a frame that is no number from 0"));
  EXPECT_THAT(second(R"({"frame":4294967295,"objects_of":[]})"), HasSubstr("is no number from 0"));
  EXPECT_THAT(second(R"({"stamp":1.5,"frame":6,"objects_of":[]})"), HasSubstr(":2: expected {"));
  EXPECT_THAT(refusal(first.substr(0, 9)), HasSubstr(":1: expected {"));
}

// The frames that a replay of the wall gives, or why it ends.
std::vector<std::uint32_t> replay(const LiveRecord& record) {
  SequenceStream wall(wall_sequence(), {.begin = 4, .end = 14});
  ReplayedStream replayed(wall, record, "record.jsonl");
  std::vector<std::uint32_t> frames;
  while (const std::optional<StreamedFrame> frame = replayed.next()) {
    frames.push_back(id_of(*frame).value);
  }
  EXPECT_EQ(replayed.dropped(), record.back().frame.value - 4 + 1 - record.size());
  return frames;
}

TEST(ReplayedStream, GivesTheFramesOfTheRecord) {
  EXPECT_EQ(replay({{FrameId(4), {}}, {FrameId(5), {}}, {FrameId(9), {}, "100.300000"}}),
            (std::vector<std::uint32_t>{4, 5, 9}));
  EXPECT_EQ(replay({{FrameId(13), {}}}), std::vector<std::uint32_t>{13});
}

TEST(ReplayedStream, OfAnotherSequenceIsRefused) {
  using testing::HasSubstr;
  EXPECT_THAT(error_of([] {
                (void)replay({{FrameId(6), {}, "1.5"}});
              }),
              HasSubstr("record.jsonl:1: frame 6 of this sequence has the stamp 100.200000; is it "
                        "the record of"));
  for (const std::uint32_t frame : {3U, 14U}) {
    EXPECT_THAT(error_of([&] {
                  (void)replay({{FrameId(frame), {}}});
                }),
                HasSubstr(fmt::format("record.jsonl:1: frame {}, which", frame)));
  }
}

}  // namespace
}  // namespace stillmap
