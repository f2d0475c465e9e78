// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/pcd.hpp"

#include "stillmap/core/append_bytes.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

std::uint32_t packed(const Rgb& color) {
  return (std::uint32_t{color[0]} << 16U) | (std::uint32_t{color[1]} << 8U) | color[2];
}

std::uint32_t label_of(const PointCloud& cloud, std::size_t i) {
  return cloud.labels.empty() ? 0U : cloud.labels[i];
}

void append_binary(std::string& bytes, const PointCloud& cloud, std::size_t i) {
  for (const float value : cloud.positions[i]) append_bytes(bytes, value);
  append_bytes(bytes, packed(cloud.colors[i]));
  append_bytes(bytes, label_of(cloud, i));
  if (cloud.normals.empty()) return;
  for (const float value : cloud.normals[i]) append_bytes(bytes, value);
}

void append_ascii(std::string& text, const PointCloud& cloud, std::size_t i) {
  for (const float value : cloud.positions[i]) text += fmt::format("{} ", value);
  text += fmt::format("{} {}", packed(cloud.colors[i]), label_of(cloud, i));
  if (!cloud.normals.empty()) {
    for (const float value : cloud.normals[i]) text += fmt::format(" {}", value);
  }
  text += '\n';
}

}  // namespace

std::string encode_pcd(const PointCloud& cloud, PcdFormat format) {
  const std::size_t count = cloud.size();
  STILLMAP_CHECK(cloud.colors.size() == count);
  STILLMAP_CHECK(cloud.labels.empty() || cloud.labels.size() == count);
  STILLMAP_CHECK(cloud.normals.empty() || cloud.normals.size() == count);
  const bool binary = format == PcdFormat::kBinary;
  const bool normals = !cloud.normals.empty();
  std::string bytes = fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\n"
      "VERSION 0.7\n"
      "FIELDS x y z rgb label{}\n"
      "SIZE 4 4 4 4 4{}\n"
      "TYPE F F F {} U{}\n"
      "COUNT 1 1 1 1 1{}\n"
      "WIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA {}\n",
      normals ? " normal_x normal_y normal_z" : "",
      normals ? " 4 4 4" : "",
      binary ? 'F' : 'U',
      normals ? " F F F" : "",
      normals ? " 1 1 1" : "",
      count,
      count,
      binary ? "binary" : "ascii");
  bytes.reserve(bytes.size() + count * ((binary ? 20U : 40U) + (normals ? 12U : 0U)));
  for (std::size_t i = 0; i < count; ++i) {
    binary ? append_binary(bytes, cloud, i) : append_ascii(bytes, cloud, i);
  }
  return bytes;
}

}  // namespace stillmap
