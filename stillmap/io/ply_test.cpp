// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/ply.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/io/atomic_file.hpp"
#include "tests/support/files.hpp"
#include "tests/support/shared_data.hpp"

namespace stillmap {
namespace {

using ::testing::HasSubstr;

PointCloud read(std::string_view bytes) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "c.ply", bytes);
  return read_ply(folder.path() / "c.ply");
}

std::string error_for(std::string_view bytes) {
  return error_of([&] { (void)read(bytes); });
}

PointCloud three_points() {
  PointCloud cloud;
  cloud.positions = {{1.5F, -2, 3}, {0, 1e-7F, 0}, {-4, 5, 6}};
  cloud.colors = {{1, 2, 3}, {255, 0, 128}, {9, 8, 7}};
  cloud.labels = {0, 15, 255};
  cloud.normals = {{0, 0, 1}, {0, -1, 0}, {1, 0, 0}};
  return cloud;
}

// 1.5 -2 3 in IEEE 754, lowest byte first.
const std::string kPoint("\x00\x00\xc0\x3f\x00\x00\x00\xc0\x00\x00\x40\x40", 12);
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

std::string ascii(const std::string& count,
                  const std::string& properties,
                  const std::string& data) {
  return "ply\nformat ascii 1.0\nelement vertex " + count + "\n" + properties + "end_header\n" +
         data;
}

std::string binary(const std::string& count,
                   const std::string& properties,
                   const std::string& data) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + count + "\n" + properties +
         "end_header\n" + data;
}

TEST(EncodePly, WritesTextOfTheFormat) {
  PointCloud cloud = three_points();
  cloud.positions[2] = {-4, 0.1F, 16777216};
  EXPECT_EQ(encode_ply(cloud, PlyFormat::kAscii),
            ascii("3",
                  kXyz + "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                         "property uchar label\n"
                         "property float nx\nproperty float ny\nproperty float nz\n",
                  "1.5 -2 3 1 2 3 0 0 0 1\n"
                  "0 1e-07 0 255 0 128 15 0 -1 0\n"
                  "-4 0.1 16777216 9 8 7 255 1 0 0\n"));
  const PointCloud again = read(encode_ply(cloud, PlyFormat::kAscii));
  EXPECT_EQ(again.positions, cloud.positions);
  EXPECT_EQ(again.colors, cloud.colors);
  EXPECT_EQ(again.labels, cloud.labels);
  EXPECT_EQ(again.normals, cloud.normals);
}

TEST(EncodePly, WritesTheBytesOfTheFormat) {
  PointCloud cloud;
  cloud.positions = {{1.5F, -2, 3}};
  cloud.colors = {{1, 2, 255}};
  EXPECT_EQ(encode_ply(cloud),
            "ply\nformat binary_little_endian 1.0\nelement vertex 1\n"
            "property float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar label\n"
            "end_header\n" +
                kPoint + std::string("\x01\x02\xff\x00", 4));
}

TEST(ReadPly, GivesBackWhatWasEncoded) {
  const PointCloud cloud = three_points();
  const PointCloud with_normals = read(encode_ply(cloud));
  EXPECT_EQ(with_normals.positions, cloud.positions);
  EXPECT_EQ(with_normals.colors, cloud.colors);
  EXPECT_EQ(with_normals.labels, cloud.labels);
  EXPECT_EQ(with_normals.normals, cloud.normals);
  EXPECT_TRUE(read(encode_ply({})).empty());
}

TEST(ReadPly, TakesPropertiesInAnyOrderAndSkipsOthers) {
  const PointCloud cloud = read(binary("2",
                                       "property uchar blue\nproperty double quality\n"
                                       "property float x\nproperty float y\nproperty float z\n"
                                       "property uchar green\nproperty uchar red\n",
                                       "\x03"
                                       "12345678" +
                                           kPoint +
                                           "\x02\x01"
                                           "\x06"
                                           "12345678" +
                                           kPoint + "\x05\x04"));
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.positions[1], Eigen::Vector3f(1.5F, -2, 3));
  EXPECT_EQ(cloud.colors[0], (Rgb{1, 2, 3}));
  EXPECT_EQ(cloud.colors[1], (Rgb{4, 5, 6}));
  EXPECT_TRUE(cloud.labels.empty());
  EXPECT_TRUE(cloud.normals.empty());
}

TEST(ReadPly, ReadsAsciiAndOtherElements) {
  const PointCloud cloud = read(
      "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement camera 1\r\nproperty float f\r\n"
      "element vertex 2\r\nproperty double x\r\nproperty int y\r\nproperty float32 z\r\n"
      "property uint16 label\r\nelement face 1\r\nproperty list uchar int vertex_indices\r\n"
      "end_header\r\n525\r\n1.5 -2 3e0 7\r\n 0.25\t1  -1 255\r\n3 0 1 1\r\n");
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.positions[0], Eigen::Vector3f(1.5F, -2, 3));
  EXPECT_EQ(cloud.positions[1], Eigen::Vector3f(0.25F, 1, -1));
  EXPECT_EQ(cloud.colors[0], (Rgb{128, 128, 128}));
  EXPECT_EQ(cloud.labels, (std::vector<std::uint8_t>{7, 255}));
}

TEST(ReadPly, SkipsABinaryElementBeforeThePoints) {
  const PointCloud cloud = read(
      "ply\nformat binary_little_endian 1.0\nelement camera 2\nproperty short f\n"
      "element vertex 1\n" +
      kXyz +
      "end_header\n"
      "abcd" +
      kPoint);
  ASSERT_EQ(cloud.size(), 1U);
  EXPECT_EQ(cloud.positions[0], Eigen::Vector3f(1.5F, -2, 3));
}

TEST(ReadPly, RefusesCountsThatTheFileIsTooShortFor) {
  for (const char* count : {"2", "1000000000000", "18446744073709551615"}) {
    EXPECT_THAT(error_for(binary(count, kXyz, kPoint)), HasSubstr("only 12 bytes")) << count;
  }
  EXPECT_THAT(error_for(ascii("1000000000000", kXyz, "1 2 3\n")), HasSubstr("only 6 bytes"));
  EXPECT_THAT(error_for(ascii("2", kXyz, "1 2 3\n")), HasSubstr("ends before its last vertex"));
  EXPECT_THAT(error_for(ascii("18446744073709551616", kXyz, "")), HasSubstr("c.ply:3"));
  EXPECT_THAT(error_for(ascii("-1", kXyz, "")), HasSubstr("whole number"));
  EXPECT_THAT(error_for("ply\nformat binary_little_endian 1.0\nelement a 9223372036854775807\n"
                        "property double f\nelement vertex 1\n" +
                        kXyz + "end_header\n" + kPoint),
              HasSubstr("no file can hold"));
  EXPECT_THAT(error_for("ply\nformat ascii 1.0\nelement a 9000000000000000000\n"
                        "property char f\nelement vertex 1\n" +
                        kXyz + "end_header\n1 2 3\n"),
              HasSubstr("c.ply"));
}

TEST(ReadPly, RefusesEveryTruncation) {
  const std::string bytes = encode_ply(three_points());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_THAT(error_for(std::string_view(bytes).substr(0, size)), HasSubstr("c.ply")) << size;
  }
}

TEST(ReadPly, RefusesWhatMakesNoPoints) {
  EXPECT_THAT(error_for(ascii("1", "property float x\nproperty float z\n", "1 2\n")),
              HasSubstr("lack x, y or z"));
  EXPECT_THAT(error_for(ascii("1", kXyz + "property uchar red\n", "1 2 3 4\n")),
              HasSubstr("red, green, blue"));
  EXPECT_THAT(error_for(ascii("1", kXyz + "property float nx\n", "1 2 3 4\n")),
              HasSubstr("nx, ny, nz"));
  EXPECT_THAT(error_for(ascii("1", kXyz, "1 nan 3\n")), HasSubstr("vertex 0 is not finite"));
  EXPECT_THAT(error_for(ascii(
                  "1", "property double x\nproperty float y\nproperty float z\n", "1e300 2 3\n")),
              HasSubstr("not finite"));
  EXPECT_THAT(error_for(ascii("1", kXyz, "1 2\n")), HasSubstr("c.ply:8: expected 3 numbers"));
  EXPECT_THAT(error_for(ascii("1", kXyz, "1 2 3 4\n")), HasSubstr("expected 3 numbers"));
  EXPECT_THAT(error_for(ascii("1", kXyz + "property int label\n", "1 2 3 256\n")),
              HasSubstr("label of vertex 0 is 256"));
  EXPECT_THAT(error_for(ascii("1", kXyz + "property list uchar int l\n", "1 2 3 0\n")),
              HasSubstr("list"));
  EXPECT_THAT(error_for(ascii("1", "", "\n")), HasSubstr("lack x, y or z"));
}

TEST(ReadPly, RefusesOtherFiles) {
  EXPECT_THAT(error_for(""), HasSubstr("c.ply"));
  EXPECT_THAT(error_for("solid\n"), HasSubstr("not a PLY"));
  EXPECT_THAT(error_for("ply\nformat binary_big_endian 1.0\nend_header\n"), HasSubstr("c.ply:2"));
  EXPECT_THAT(error_for("ply\nformat ascii 1.0\nend_header\n"), HasSubstr("no element 'vertex'"));
  EXPECT_THAT(error_for("ply\nelement vertex 0\n" + kXyz + "end_header\n"), HasSubstr("format"));
  EXPECT_THAT(error_for("ply\nproperty float x\n"), HasSubstr("no element"));
  EXPECT_THAT(error_for(ascii("1", "property quad x\n", "1\n")), HasSubstr("unknown type"));
  EXPECT_THAT(error_for("ply\nrubbish\n"), HasSubstr("c.ply:2"));
  EXPECT_THAT(error_for("ply\n" + std::string(100000, 'x')), HasSubstr("no end of a PLY header"));
}

TEST(ReadPly, ReadsTheSharedMaps) {
  STILLMAP_NEED_SHARED_DATA("fr1_xyz_walkers");
  EXPECT_EQ(read_ply(shared_data("fr1_xyz_walkers/truth/static_map.ply")).size(), 308853U);
}

}  // namespace
}  // namespace stillmap
