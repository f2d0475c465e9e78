// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/pcd.hpp"

#include <gtest/gtest.h>

namespace stillmap {
namespace {

PointCloud cloud() {
  PointCloud cloud;
  cloud.positions = {{1.5F, -2, 3}, {0, 1e-7F, 0.1F}};
  cloud.colors = {{1, 2, 3}, {255, 0, 128}};
  cloud.labels = {0, 15};
  return cloud;
}

TEST(EncodePcd, WritesTheBytesOfTheFormat) {
  PointCloud one = cloud();
  one.positions.resize(1);
  one.colors.resize(1);
  one.labels = {7};
  EXPECT_EQ(encode_pcd(one, PcdFormat::kBinary),
            "# .PCD v0.7 - Point Cloud Data file format\n"
            "VERSION 0.7\nFIELDS x y z rgb label\nSIZE 4 4 4 4 4\nTYPE F F F F U\nCOUNT 1 1 1 1 1\n"
            "WIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA binary\n" +
                std::string("\x00\x00\xc0\x3f\x00\x00\x00\xc0\x00\x00\x40\x40"
                            "\x03\x02\x01\x00"
                            "\x07\x00\x00\x00",
                            20));
}

TEST(EncodePcd, WritesText) {
  EXPECT_EQ(encode_pcd(cloud(), PcdFormat::kAscii),
            "# .PCD v0.7 - Point Cloud Data file format\n"
            "VERSION 0.7\nFIELDS x y z rgb label\nSIZE 4 4 4 4 4\nTYPE F F F U U\nCOUNT 1 1 1 1 1\n"
            "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n"
            "1.5 -2 3 66051 0\n"
            "0 1e-07 0.1 16711808 15\n");
}

TEST(EncodePcd, WithNormalsAndWithoutLabels) {
  PointCloud with_normals = cloud();
  with_normals.labels.clear();
  with_normals.normals = {{0, 0, 1}, {0, -1, 0}};
  const std::string text = encode_pcd(with_normals, PcdFormat::kAscii);
  EXPECT_NE(text.find("FIELDS x y z rgb label normal_x normal_y normal_z\n"
                      "SIZE 4 4 4 4 4 4 4 4\nTYPE F F F U U F F F\nCOUNT 1 1 1 1 1 1 1 1\n"),
            std::string::npos);
  EXPECT_NE(text.find("\n1.5 -2 3 66051 0 0 0 1\n"), std::string::npos);
  const std::string bytes = encode_pcd(with_normals, PcdFormat::kBinary);
  EXPECT_EQ(bytes.size() - bytes.find("DATA binary\n") - 12, 2U * 32U);
  EXPECT_EQ(bytes.substr(bytes.size() - 12),
            std::string("\x00\x00\x00\x00\x00\x00\x80\xbf\x00\x00\x00\x00", 12));
}

}  // namespace
}  // namespace stillmap
