// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/mesh_files.hpp"

#include <cmath>
#include <map>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "stillmap/core/append_bytes.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

void put_vector(std::string& bytes, const Eigen::Vector3f& v) {
  for (const float value : v) append_bytes(bytes, value);
}

void check(const SurfaceMesh& mesh) {
  const PointCloud& v = mesh.vertices;
  STILLMAP_CHECK(v.colors.size() == v.size() && v.normals.size() == v.size());
  STILLMAP_CHECK(v.labels.size() == v.size());
}

/// The parts of a glTF buffer, each described by a view and an accessor.
class GltfBuffer {
 public:
  enum class Target { kVertices = 34962, kIndices = 34963 };
  enum class Component { kUint8 = 5121, kUint32 = 5125, kFloat = 5126 };

  /// Begins a part; its data is to be appended to bytes().
  void begin() { first_ = bytes_.size(); }
  /// Ends it and returns the index of its accessor. `stride` in bytes, 0: packed.
  int end(Target target,
          Component component,
          const char* type,
          std::size_t count,
          std::size_t stride = 0) {
    nlohmann::json view = {{"buffer", 0},
                           {"byteOffset", first_},
                           {"byteLength", bytes_.size() - first_},
                           {"target", static_cast<int>(target)}};
    if (stride > 0) view["byteStride"] = stride;
    accessors_.push_back({{"bufferView", views_.size()},
                          {"componentType", static_cast<int>(component)},
                          {"count", count},
                          {"type", type}});
    views_.push_back(std::move(view));
    return static_cast<int>(accessors_.size()) - 1;
  }

  [[nodiscard]] std::string& bytes() { return bytes_; }
  [[nodiscard]] nlohmann::json& accessor(int index) {
    return accessors_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] const nlohmann::json& accessors() const { return accessors_; }
  [[nodiscard]] const nlohmann::json& views() const { return views_; }

 private:
  std::string bytes_;
  std::size_t first_ = 0;
  nlohmann::json views_ = nlohmann::json::array(), accessors_ = nlohmann::json::array();
};

/// glTF's colours are linear; those of cameras have the curve of sRGB.
std::uint8_t linear(std::uint8_t srgb) {
  const double c = srgb / 255.0;
  const double value = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  return static_cast<std::uint8_t>(std::lround(255 * value));
}

int add_positions(GltfBuffer& buffer, const PointCloud& vertices) {
  buffer.begin();
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : vertices.positions) {
    put_vector(buffer.bytes(), p);
    box.extend(p);
  }
  const int accessor = buffer.end(
      GltfBuffer::Target::kVertices, GltfBuffer::Component::kFloat, "VEC3", vertices.size());
  buffer.accessor(accessor)["min"] = {box.min().x(), box.min().y(), box.min().z()};
  buffer.accessor(accessor)["max"] = {box.max().x(), box.max().y(), box.max().z()};
  return accessor;
}

int add_normals(GltfBuffer& buffer, const PointCloud& vertices) {
  buffer.begin();
  for (const Eigen::Vector3f& n : vertices.normals) put_vector(buffer.bytes(), n);
  return buffer.end(
      GltfBuffer::Target::kVertices, GltfBuffer::Component::kFloat, "VEC3", vertices.size());
}

int add_colors(GltfBuffer& buffer, const PointCloud& vertices) {
  buffer.begin();
  for (const Rgb& color : vertices.colors) {
    for (const std::uint8_t c : color) append_bytes(buffer.bytes(), linear(c));
    append_bytes(buffer.bytes(), std::uint8_t{255});
  }
  const int accessor = buffer.end(
      GltfBuffer::Target::kVertices, GltfBuffer::Component::kUint8, "VEC4", vertices.size());
  buffer.accessor(accessor)["normalized"] = true;
  return accessor;
}

/// Each label takes four bytes, because attributes begin at multiples of four.
int add_labels(GltfBuffer& buffer, const PointCloud& vertices) {
  buffer.begin();
  for (const std::uint8_t label : vertices.labels)
    append_bytes(buffer.bytes(), std::uint32_t{label});
  return buffer.end(
      GltfBuffer::Target::kVertices, GltfBuffer::Component::kUint8, "SCALAR", vertices.size(), 4);
}

int add_triangles(GltfBuffer& buffer, const SurfaceMesh& mesh) {
  buffer.begin();
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t i : triangle) append_bytes(buffer.bytes(), i);
  }
  return buffer.end(GltfBuffer::Target::kIndices,
                    GltfBuffer::Component::kUint32,
                    "SCALAR",
                    3 * mesh.triangles.size());
}

/// A chunk of a GLB, filled up to a multiple of four bytes.
void put_chunk(std::string& bytes, std::string_view type, std::string data, char filler) {
  data.resize((data.size() + 3) / 4 * 4, filler);
  append_bytes(bytes, static_cast<std::uint32_t>(data.size()));
  bytes += type;
  bytes += data;
}

}  // namespace

std::string encode_mesh_ply(const SurfaceMesh& mesh) {
  check(mesh);
  const PointCloud& vertices = mesh.vertices;
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar label\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      vertices.size(),
      mesh.triangles.size());
  bytes.reserve(bytes.size() + 28 * vertices.size() + 13 * mesh.triangles.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    put_vector(bytes, vertices.positions[i]);
    put_vector(bytes, vertices.normals[i]);
    for (const std::uint8_t c : vertices.colors[i]) append_bytes(bytes, c);
    append_bytes(bytes, vertices.labels[i]);
  }
  for (const auto& triangle : mesh.triangles) {
    append_bytes(bytes, std::uint8_t{3});
    for (const std::uint32_t i : triangle) append_bytes(bytes, i);
  }
  return bytes;
}

std::string encode_mesh_obj(const SurfaceMesh& mesh) {
  check(mesh);
  const PointCloud& vertices = mesh.vertices;
  std::string text = "# stillmap: v x y z red green blue, metres\n";
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3f& p = vertices.positions[i];
    const Rgb& c = vertices.colors[i];
    text += fmt::format("v {:.4f} {:.4f} {:.4f} ", p.x(), p.y(), p.z());
    text += fmt::format("{:.4f} {:.4f} {:.4f}\n", c[0] / 255.0, c[1] / 255.0, c[2] / 255.0);
  }
  for (const Eigen::Vector3f& n : vertices.normals) {
    text += fmt::format("vn {:.3f} {:.3f} {:.3f}\n", n.x(), n.y(), n.z());
  }
  std::map<int, std::string> groups;
  for (const auto& t : mesh.triangles) {
    groups[vertices.labels[t[0]]] +=
        fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  for (const auto& [label, faces] : groups) {
    text += fmt::format("g label_{}\n", label);
    text += faces;
  }
  return text;
}

std::string encode_mesh_glb(const SurfaceMesh& mesh) {
  check(mesh);
  GltfBuffer buffer;
  const nlohmann::json attributes = {{"POSITION", add_positions(buffer, mesh.vertices)},
                                     {"NORMAL", add_normals(buffer, mesh.vertices)},
                                     {"COLOR_0", add_colors(buffer, mesh.vertices)},
                                     {"_LABEL", add_labels(buffer, mesh.vertices)}};
  const int indices = add_triangles(buffer, mesh);
  const nlohmann::json gltf = {
      {"asset", {{"version", "2.0"}, {"generator", "stillmap"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}, {"rotation", {1, 0, 0, 0}}}}},
      {"materials",
       {{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}},
         {"doubleSided", true}}}},
      {"meshes",
       {{{"primitives", {{{"attributes", attributes}, {"indices", indices}, {"material", 0}}}}}}},
      {"buffers", {{{"byteLength", buffer.bytes().size()}}}},
      {"bufferViews", buffer.views()},
      {"accessors", buffer.accessors()}};
  std::string chunks;
  put_chunk(chunks, "JSON", gltf.dump(), ' ');
  put_chunk(chunks, std::string_view("BIN\0", 4), std::move(buffer.bytes()), '\0');
  std::string bytes = "glTF";
  append_bytes(bytes, std::uint32_t{2});
  append_bytes(bytes, static_cast<std::uint32_t>(12 + chunks.size()));
  return bytes + chunks;
}

std::string encode_mesh(const SurfaceMesh& mesh, const std::filesystem::path& file) {
  const std::filesystem::path suffix = file.extension();
  if (suffix == ".ply") return encode_mesh_ply(mesh);
  if (suffix == ".obj") return encode_mesh_obj(mesh);
  if (suffix == ".glb") return encode_mesh_glb(mesh);
  throw Error("{}: expected a name that ends in .ply, .obj or .glb", file.string());
}

}  // namespace stillmap
