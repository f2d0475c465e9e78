// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/session_io.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "tests/support/files.hpp"
#include "tests/support/session_sections.hpp"
#include "tests/support/sessions.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;

template <class Action>
std::string error_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(SessionIo, WhatIsReadIsWhatWasWritten) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const Session session = random_session(seed);
    ASSERT_GE(session.map.landmark_count(), 3U);
    const std::string bytes = encode_session(session);
    const Session read = decode_session(bytes, "x");
    read.map.check_consistency();
    expect_same(read, session);
    EXPECT_EQ(encode_session(read), bytes);
    for (std::uint32_t k = 0; k < 6; ++k) {
      EXPECT_EQ(read.map.T_world_keyframe(KeyframeId(k)).matrix(),
                session.map.T_world_keyframe(KeyframeId(k)).matrix());
    }
  }
}

TEST(SessionIo, UnusualNumbersKeepTheirBits) {
  Session session = random_session(1);
  FrameRecord unusual = session.frames[0];
  unusual.T_reference_frame =
      Eigen::Isometry3d(Eigen::Translation3d(-0.0, std::numeric_limits<double>::denorm_min(), 0.1));
  session.frames.set(0, unusual);
  const Session read = decode_session(encode_session(session), "x");
  const Eigen::Vector3d t = read.frames[0].T_reference_frame.translation();
  EXPECT_TRUE(std::signbit(t.x()));
  EXPECT_EQ(t.y(), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(t.z(), 0.1);
}

TEST(SessionIo, AnEmptySessionIsOne) {
  const Session session{test_session_detail::camera(), "", Map({1.0F}), {}, {}, {}};
  const std::string bytes = encode_session(session);
  const Session read = decode_session(bytes, "x");
  expect_same(read, session);
  EXPECT_EQ(encode_session(read), bytes);
}

TEST(SessionIo, ManyLandmarksComeInSeveralParts) {
  const Session session =
      random_session(1, {.keyframes = 5, .features = 30000, .operations = 0, .frames = 1});
  Map map = session.map;
  for (const std::uint32_t k : {0U, 1U, 4U}) {
    for (std::uint32_t i = 0; i < 30000; ++i) {
      if (!map.keyframe(KeyframeId(k)).landmarks[i].valid()) {
        map.add_landmark({1, 2, 3}, {KeyframeId(k), i});
      }
    }
  }
  ASSERT_EQ(map.landmark_count(), 90000U);
  const Session large{session.camera, "", map, {}, {}, {}};
  const std::string bytes = encode_session(large);
  EXPECT_EQ(decode_session(bytes, "x").map.landmark_count(), 90000U);
  EXPECT_EQ(encode_session(decode_session(bytes, "x")), bytes);

  std::vector<RawSection> sections = split_sections(bytes);
  std::erase_if(sections, [](const RawSection& s) { return s.tag == "LMRK"; });
  EXPECT_EQ(decode_session(join_sections(sections), "x").map.landmark_count(), 0U);
}

TEST(SessionIo, AFileIsTheSameAsBytes) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "map.stillmap";
  const Session session = random_session(5);
  write_session(path, session);
  EXPECT_EQ(read_file(path, 1U << 20U), encode_session(session));
  expect_same(read_session(path), session);
}

std::uint32_t version_of(const std::string& bytes) {
  return ByteReader(bytes.substr(kSessionMagic.size(), 4), "").number<std::uint32_t>();
}

TEST(SessionIo, OnlyACameraThatVersion2CannotDescribeMakesVersion3) {
  Session session = random_session(5);
  const std::string plain = encode_session(session);
  EXPECT_EQ(version_of(plain), 2U);
  session.camera.k5 = 0.25;
  const std::string rational = encode_session(session);
  EXPECT_EQ(version_of(rational), 3U);
  EXPECT_EQ(rational.size(), plain.size() + 4 + 3 * 8);
  expect_same(decode_session(rational, "rational"), session);
  session.camera.k5 = session.camera.p1 = session.camera.p2 = 0;
  session.camera.lens = LensModel::kFisheye;
  const std::string fisheye = encode_session(session);
  EXPECT_EQ(version_of(fisheye), 3U);
  expect_same(decode_session(fisheye, "fisheye"), session);
}

TEST(SessionIo, OnlyAViewOfAnotherTimeThanItsFrameMakesVersion4) {
  Session session = random_session(5);
  const std::size_t plain = encode_session(session).size();
  session.views[0].depth_after_color_s = -0.025;
  const std::string timed = encode_session(session);
  EXPECT_EQ(version_of(timed), 4U);
  EXPECT_EQ(timed.size(), plain + 8);
  expect_same(decode_session(timed, "timed"), session);
  session.views[0].depth_after_color_s = std::nan("");
  EXPECT_THROW((void)encode_session(session), Error);
}

TEST(SessionIo, WithoutViewsTheyAreNotRead) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "map.stillmap";
  const Session session = random_session(5);
  std::string bytes = encode_session(session);
  bytes[bytes.rfind("VIEW") + 30] ^= 1;  // in the last view
  write_file_atomically(path, bytes);
  EXPECT_THAT(error_of([&] { (void)read_session(path); }), HasSubstr("VIEW"));
  const Session read = read_session(path, {.with_views = false});
  EXPECT_TRUE(read.views.empty());
  expect_same_without_views(read, session);
}

TEST(SessionIo, WhatCouldNotBeReadIsNotWritten) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "map.stillmap";
  write_file_atomically(path, "old");
  Session session = random_session(5);
  FrameRecord broken = session.frames[2];
  broken.T_reference_frame(0, 0) = std::numeric_limits<double>::quiet_NaN();
  session.frames.set(2, broken);
  EXPECT_THAT(error_of([&] { write_session(path, session); }),
              HasSubstr("cannot write " + path.string() + ": invalid frame 2: its pose"));
  EXPECT_EQ(read_file(path, 100), "old");
  EXPECT_THROW(write_session(folder.path() / "none" / "a", random_session(5)), Error);
}

TEST(SessionIo, NamesWhatIsNoFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of([&] { (void)read_session(folder.path() / "none"); }), HasSubstr("none"));
  EXPECT_THROW((void)read_session(folder.path()), Error);
}

}  // namespace
}  // namespace stillmap
