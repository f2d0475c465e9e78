// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/bytes.hpp"

#include <array>

#include <gtest/gtest.h>

#include "stillmap/session/sections.hpp"

namespace stillmap {
namespace {

TEST(Bytes, AreLittleEndianWithoutGaps) {
  ByteWriter out;
  out.number<std::uint8_t>(1);
  out.number<std::int32_t>(-2);
  out.number<std::uint64_t>(0x0102030405060708U);
  out.number(1.0);    // 0x3ff0000000000000
  out.number(-2.0F);  // 0xc0000000
  out.flag(true);
  out.text("ab");
  out.array<std::uint16_t>(std::vector<std::array<std::uint16_t, 2>>{{0x0102, 0x0304}});
  const char expected[] =
      "\x01\xfe\xff\xff\xff\x08\x07\x06\x05\x04\x03\x02\x01"
      "\0\0\0\0\0\0\xf0\x3f\0\0\0\xc0\x01\x02\0\0\0ab\x02\x01\x04\x03";
  EXPECT_EQ(out.bytes(), std::string(expected, sizeof(expected) - 1));
}

TEST(Bytes, PosesAreThreeRows) {
  Eigen::Isometry3d T(Eigen::Translation3d(10, 20, 30));
  T.linear() << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  ByteWriter out;
  out.pose(T);
  ByteReader in(out.bytes(), "x");
  const auto numbers = in.array<double, double>(12);
  EXPECT_EQ(numbers, (std::vector<double>{1, 2, 3, 10, 4, 5, 6, 20, 7, 8, 9, 30}));
  EXPECT_EQ(ByteReader(out.bytes(), "x").pose().matrix(), T.matrix());
}

TEST(Bytes, NothingIsReadBeyondTheEnd) {
  const std::string bytes("\xff\xff\xff\xff\x02", 5);
  const auto reader = [&] { return ByteReader(bytes, "x"); };
  EXPECT_THROW((void)reader().number<double>(), Error);
  EXPECT_THROW((void)reader().text(), Error);
  EXPECT_THROW((void)reader().count(1), Error);
  EXPECT_THROW((void)reader().count(std::size_t{1} << 60U), Error);
  EXPECT_THROW((void)(reader().array<std::uint32_t, std::uint32_t>(2)), Error);
  EXPECT_THROW((void)(reader().array<std::uint64_t, std::uint64_t>(std::size_t{1} << 61U)), Error);
  EXPECT_THROW((void)reader().flag(), Error);
  EXPECT_THROW(reader().finish(), Error);
  ByteReader all = reader();
  EXPECT_EQ(all.number<std::uint32_t>(), 0xffffffffU);
  EXPECT_EQ(all.number<std::uint8_t>(), 2);
  EXPECT_NO_THROW(all.finish());
}

TEST(Bytes, ChecksumIsTheUsualCrc32) {
  EXPECT_EQ(checksum("123456789"), 0xcbf43926U);  // the check value of its definition
  EXPECT_EQ(checksum("456789", checksum("123")), 0xcbf43926U);
}

}  // namespace
}  // namespace stillmap
