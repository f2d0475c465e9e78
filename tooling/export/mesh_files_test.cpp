// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/mesh_files.hpp"

#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/ply.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

/// Two triangles with a common side.
SurfaceMesh roof() {
  SurfaceMesh mesh;
  mesh.vertices.positions = {{0, 0, 0}, {1, 0, 0.5F}, {0, 2, 0.25F}, {1, 2, -1}};
  mesh.vertices.normals.assign(4, Eigen::Vector3f(0, 0, 1));
  mesh.vertices.colors = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {188, 188, 188}};
  mesh.vertices.labels = {0, 57, 57, 63};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  return mesh;
}

template <class T>
T value_at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

TEST(MeshFiles, ThePlyHasVerticesThatReadBackAndFaces) {
  const SurfaceMesh mesh = roof();
  const std::string bytes = encode_mesh_ply(mesh);
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "mesh.ply", bytes);
  const PointCloud back = read_ply(folder.path() / "mesh.ply");
  EXPECT_EQ(back.positions, mesh.vertices.positions);
  EXPECT_EQ(back.normals, mesh.vertices.normals);
  EXPECT_EQ(back.colors, mesh.vertices.colors);
  EXPECT_EQ(back.labels, mesh.vertices.labels);
  const std::size_t faces = bytes.size() - 2 * 13;
  EXPECT_EQ(bytes[faces + 13], 3);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, faces + 14), 1U);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, faces + 18), 3U);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, faces + 22), 2U);
}

TEST(MeshFiles, TheObjCountsFromOneAndGroupsByLabel) {
  std::istringstream text(encode_mesh_obj(roof()));
  std::string line, all;
  int vertices = 0, normals = 0;
  while (std::getline(text, line)) {
    vertices += line.starts_with("v ") ? 1 : 0;
    normals += line.starts_with("vn ") ? 1 : 0;
    if (line.starts_with("g ") || line.starts_with("f ")) all += line + "\n";
  }
  EXPECT_EQ(vertices, 4);
  EXPECT_EQ(normals, 4);
  EXPECT_EQ(all, "g label_0\nf 1//1 2//2 3//3\ng label_57\nf 2//2 4//4 3//3\n");
}

TEST(MeshFiles, TheGlbDescribesItsBuffer) {
  const SurfaceMesh mesh = roof();
  const std::string bytes = encode_mesh_glb(mesh);
  ASSERT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 4), 2U);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 8), bytes.size());
  const auto json_size = value_at<std::uint32_t>(bytes, 12);
  EXPECT_EQ(json_size % 4, 0U);
  const auto gltf = nlohmann::json::parse(bytes.substr(20, json_size));
  const std::string buffer = bytes.substr(28 + json_size);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 20 + json_size), buffer.size());
  EXPECT_EQ(gltf["buffers"][0]["byteLength"], buffer.size());
  const auto at = [&](const nlohmann::json& index) {
    const auto& accessor = gltf["accessors"][index.get<std::size_t>()];
    return gltf["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"]
        .get<std::size_t>();
  };
  const auto& primitive = gltf["meshes"][0]["primitives"][0];
  EXPECT_EQ(value_at<float>(buffer, at(primitive["attributes"]["POSITION"]) + 12 * 3 + 4), 2.0F);
  EXPECT_EQ(value_at<std::uint8_t>(buffer, at(primitive["attributes"]["_LABEL"]) + 4), 57);
  EXPECT_EQ(value_at<std::uint32_t>(buffer, at(primitive["indices"]) + 4 * 4), 3U);
  // 188 on the curve of sRGB is half of the light.
  EXPECT_NEAR(value_at<std::uint8_t>(buffer, at(primitive["attributes"]["COLOR_0"]) + 12), 128, 1);
}

}  // namespace
}  // namespace stillmap
