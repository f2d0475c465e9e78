// SPDX-License-Identifier: Apache-2.0
// Session files that are truncated, damaged or made to deceive.
#include <cmath>
#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/session/session_io.hpp"
#include "tests/support/session_sections.hpp"
#include "tests/support/sessions.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

constexpr TestSessionSize kSmall{.keyframes = 5, .features = 3, .frames = 5, .points = 2};

// The message, or nothing when it can be read; anything but an Error fails the test.
std::string problem(const std::string& bytes) {
  try {
    const Session session = decode_session(bytes, "a.stillmap");
    session.map.check_consistency();
    EXPECT_EQ(encode_session(session), bytes);
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), MatchesRegex("a.stillmap: [ -~]*"));
    return error.what();
  }
  return "";
}

TEST(SessionDamage, EveryTruncationIsFound) {
  const std::string bytes = encode_session(random_session(1, kSmall));
  ASSERT_EQ(problem(bytes), "");
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THAT(problem(bytes.substr(0, size)), HasSubstr(size == 0 ? "not a still" : "truncated"))
        << size;
  }
  EXPECT_THAT(problem(bytes + '\0'), HasSubstr("1 bytes behind its end"));
}

TEST(SessionDamage, EveryChangedByteIsFound) {
  const std::string bytes = encode_session(random_session(1, kSmall));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const int change : {0x01, 0x20, 0x80, 0xff}) {
      std::string changed = bytes;
      changed[i] = static_cast<char>(changed[i] ^ change);
      EXPECT_NE(problem(changed), "") << i;
    }
  }
}

TEST(SessionDamage, SaysWhatItIs) {
  const std::string bytes = encode_session(random_session(1, kSmall));
  EXPECT_THAT(problem("ply\nformat ascii"), HasSubstr("not a stillmap session: expected"));
  EXPECT_THAT(problem("stillm"), HasSubstr("truncated"));
  EXPECT_THAT(problem(session_head(7) + bytes.substr(kSessionHeadSize)),
              HasSubstr("written by a newer stillmap (format 7; this one reads 4): install"));
  EXPECT_THAT(
      problem(session_head(1) + bytes.substr(kSessionHeadSize)),
      HasSubstr("written by an older stillmap (format 1; this one reads 4): make it again"));
  EXPECT_NE(problem(session_head(0) + bytes.substr(kSessionHeadSize)), "");
  std::string changed = bytes;
  changed[40] ^= 1;
  EXPECT_THAT(problem(changed), HasSubstr("part CAMR at byte 16: damaged: the checksum is wrong"));
}

// Files with the right checksums but wrong sections.
TEST(SessionDamage, SectionsHaveTheirOrder) {
  const std::vector<RawSection> sections =
      split_sections(encode_session(random_session(1, kSmall)));
  ASSERT_EQ(problem(join_sections(sections)), "");
  for (std::size_t i = 0; i < sections.size(); ++i) {
    std::vector<RawSection> without = sections, twice = sections, empty = sections;
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
    twice.insert(twice.begin() + static_cast<std::ptrdiff_t>(i), sections[i]);
    empty[i].content.clear();
    // Views and objects may be missing, and who knows of key frames and landmarks that nothing
    // refers to.
    const std::string& tag = sections[i].tag;
    if (tag != "VIEW" && tag != "LMRK" && tag != "KEYF" && tag != "OBJS") {
      EXPECT_NE(problem(join_sections(without)), "") << sections[i].tag;
    }
    EXPECT_NE(problem(join_sections(twice)), "") << sections[i].tag;
    EXPECT_NE(problem(join_sections(empty)), "") << sections[i].tag;
  }
}

// Any four or eight bytes, so every count, id and number, made the greatest, the least and others.
TEST(SessionDamage, AnyNumberMayDeceive) {
  const std::vector<RawSection> sections =
      split_sections(encode_session(random_session(1, kSmall)));
  std::vector<std::string> values;
  for (const std::uint32_t v : {0xffffffffU, 0xfffffffeU, 0x7fffffffU, 0x80000000U, 65536U, 0U}) {
    ByteWriter out;
    out.number(v);
    values.push_back(out.bytes());
  }
  for (const double v : {std::numeric_limits<double>::quiet_NaN(), 1e300, -1.0}) {
    ByteWriter out;
    out.number(v);
    values.push_back(out.bytes());
  }
  int refused = 0, tried = 0;
  for (std::size_t s = 0; s < sections.size(); ++s) {
    for (std::size_t i = 0; i < sections[s].content.size(); ++i) {
      for (const std::string& value : values) {
        std::vector<RawSection> changed = sections;
        changed[s].content.replace(
            i, std::min(value.size(), sections[s].content.size() - i), value);
        refused += problem(join_sections(changed)).empty() ? 0 : 1;
        ++tried;
      }
    }
  }
  // Descriptors, colours and the like may be anything.
  EXPECT_GT(refused, tried / 4);
  EXPECT_LT(refused, tried);
}

struct Wrong {
  std::string part_of_message;
  std::function<void(Session&)> change;
};

TEST(SessionDamage, WrongRecordsAreRefused) {
  const auto view = [](Session& s, const std::function<void(StaticView&)>& change) {
    StaticView changed = *s.views[1].view;
    change(changed);
    s.views[1].view = std::make_shared<const StaticView>(std::move(changed));
  };
  const auto frame = [](Session& s, const std::function<void(FrameRecord&)>& change) {
    FrameRecord changed = s.frames[2];
    change(changed);
    s.frames.set(2, std::move(changed));
  };
  using S = Session&;
  using F = FrameRecord&;
  const std::vector<Wrong> wrongs = {
      {"fx", [](S s) { s.camera.fx = 0; }},
      {"width", [](S s) { s.camera.width_px = 10000; }},
      {"settings", [](S s) { s.config_yaml.assign((1U << 20U) + 1, ' '); }},
      {"loop 1: its key frames", [](S s) { s.loops[1].b = s.loops[1].a; }},
      {"loop 1: its key frames", [](S s) { s.loops[1].b = KeyframeId(9); }},
      {"loop 1: its pose", [](S s) { s.loops[1].T_a_b(0, 0) += 1; }},
      {"loop 1: its pose", [](S s) { s.loops[1].sigma_rad = 0; }},
      {"frame 2: its stamp", [&](S s) { frame(s, [](F f) { f.stamp.text = "1 2"; }); }},
      {"frame 2: its stamp", [&](S s) { frame(s, [](F f) { f.stamp.seconds = NAN; }); }},
      {"frame 2: its key frame", [&](S s) { frame(s, [](F f) { f.reference = KeyframeId(5); }); }},
      {"frame 2: its pose", [&](S s) { frame(s, [](F f) { f.T_reference_frame(0, 0) = 3; }); }},
      {"view 1: its frame", [](S s) { s.views[1].frame = 5; }},
      {"view 1: its frame", [](S s) { s.views[1].frame = s.views[0].frame; }},
      {"view 1: it is empty", [](S s) { s.views[1].view = nullptr; }},
      {"view 1: arrays", [&](S s) { view(s, [](StaticView& v) { v.cloud.colors.pop_back(); }); }},
      {"view 1: arrays", [&](S s) { view(s, [](StaticView& v) { v.cloud.labels.pop_back(); }); }},
      {"view 1: its time", [](S s) { s.views[1].depth_after_color_s = NAN; }},
      {"view 1: its time", [](S s) { s.views[1].depth_after_color_s = -1.5; }},
      {"view 1: where", [&](S s) { view(s, [](StaticView& v) { v.cloud.origin.z() = NAN; }); }},
      {"view 1: where", [&](S s) { view(s, [](StaticView& v) { v.cloud.origin.x() = 2e9F; }); }},
      {"view 1: where", [&](S s) { view(s, [](StaticView& v) { v.cloud.step.y() = -1e-9F; }); }},
      {"view 1: where", [&](S s) { view(s, [](StaticView& v) { v.cloud.step.x() = 2e4F; }); }},
      {"view 1: the size of its blocks",
       [&](S s) { view(s, [](StaticView& v) { v.range.block_px = 0; }); }},
      {"view 1: the size of its range image",
       [&](S s) { view(s, [](StaticView& v) { v.range.cells.pop_back(); }); }},
      {"view 1: the size of its range image",
       [&](S s) { view(s, [](StaticView& v) { v.range.block_px = 4; }); }},
  };
  for (const Wrong& wrong : wrongs) {
    Session session = random_session(1, kSmall);
    ASSERT_EQ(session.views.size(), 2U);
    wrong.change(session);
    try {
      (void)encode_session(session);
      ADD_FAILURE() << "accepted: " << wrong.part_of_message;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(wrong.part_of_message));
    }
  }
}

// Hardly any bytes, but a grid of a million cells for each key frame.
TEST(SessionDamage, MemoryIsInProportionToTheFile) {
  Session session = random_session(1, {.keyframes = 600, .features = 1});
  session.views.clear();
  std::vector<RawSection> sections = split_sections(encode_session(session));
  session.camera.width_px = session.camera.height_px = 8192;
  EXPECT_THROW((void)encode_session(session), Error);
  const Session no_map{session.camera, "", Map({1.0F}), {}, {}, {}};
  sections[0] = split_sections(encode_session(no_map))[0];
  ASSERT_EQ(sections[0].tag, "CAMR");
  const std::string bytes = join_sections(sections);
  ASSERT_LT(bytes.size(), 200000U);
  EXPECT_THAT(problem(bytes), HasSubstr("hardly any features"));
}

}  // namespace
}  // namespace stillmap
