// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/asset_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include <opencv2/imgproc.hpp>
#include <tiny_obj_loader.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMaxObjectBytes = std::size_t{64} << 20U;
constexpr std::size_t kMaxMaterialBytes = std::size_t{1} << 20U;
constexpr std::size_t kMaxPictureBytes = std::size_t{32} << 20U;
constexpr std::size_t kMaxTriangles = 400000;
constexpr int kMaxPictureSide_px = 1024;
constexpr float kClear = 0.3F;  // more transparent materials are left out

std::string folder_of(const std::string& entry) {
  return entry.substr(0, entry.find_last_of('/') + 1);
}

// The material files that an OBJ file names, one after the other.
std::string material_text(const AssetArchive& archive,
                          const std::string& folder,
                          std::string_view object) {
  constexpr std::string_view kKey = "mtllib ";
  std::string text;
  for (std::size_t at = object.find(kKey); at != std::string_view::npos;
       at = object.find(kKey, at + 1)) {
    if (at > 0 && object[at - 1] != '\n') continue;
    std::string_view name = object.substr(at + kKey.size());
    name = name.substr(0, name.find_first_of("\r\n"));
    while (name.ends_with(' ')) name.remove_suffix(1);
    text += archive.read(folder + std::string(name), kMaxMaterialBytes) + '\n';
  }
  return text;
}

cv::Mat3b shrunk(const cv::Mat3b& picture) {
  const int side = std::max(picture.cols, picture.rows);
  if (side <= kMaxPictureSide_px) return picture;
  const double scale = static_cast<double>(kMaxPictureSide_px) / side;
  cv::Mat3b small;
  cv::resize(picture, small, {}, scale, scale, cv::INTER_AREA);
  return small;
}

cv::Vec3b plain_color(const tinyobj::real_t (&diffuse)[3]) {
  cv::Vec3b rgb;
  for (int i = 0; i < 3; ++i) {
    const float share = std::isfinite(diffuse[i]) ? std::clamp(diffuse[i], 0.F, 1.F) : 0.F;
    rgb[i] = static_cast<std::uint8_t>(std::lround(255.F * share));
  }
  return rgb;
}

using Place = std::array<float, 3>;

Place place_of(const Eigen::Vector3f& p) {
  return {p.x(), p.y(), p.z()};
}

// Twice the area as its length.
Eigen::Vector3f face_normal(const Mesh& mesh, std::size_t triangle) {
  const Mesh::Triangle& t = mesh.triangles[triangle];
  const Eigen::Vector3f& a = mesh.positions[t[0]];
  return (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a);
}

// The triangle's normal at one of its corners: the mean of adjacent faces that are not turned far
// against it, so that edges stay sharp.
Eigen::Vector3f creased_normal(const Mesh& mesh,
                               std::size_t triangle,
                               const std::vector<std::size_t>& around) {
  constexpr float kSharpest = 0.7F;  // cosine
  const Eigen::Vector3f own = face_normal(mesh, triangle).normalized();
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const std::size_t other : around) {
    const Eigen::Vector3f normal = face_normal(mesh, other);
    if (normal.dot(own) >= kSharpest * normal.norm()) sum += normal;
  }
  return sum.norm() > 0 ? Eigen::Vector3f(sum.normalized()) : Eigen::Vector3f::UnitY();
}

// The same with unit normals where there were none; corners on sharp edges are duplicated.
Mesh with_normals(const Mesh& mesh) {
  std::map<Place, std::vector<std::size_t>> around;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t c : mesh.triangles[t]) {
      around[place_of(mesh.positions[c])].push_back(t);
    }
  }
  std::map<std::pair<std::uint32_t, Place>, std::uint32_t> corners;
  Mesh result;
  result.materials = mesh.materials;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Mesh::Triangle triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t c = mesh.triangles[t][i];
      const float length = mesh.normals[c].norm();
      const Eigen::Vector3f normal =
          length > 1e-6F ? Eigen::Vector3f(mesh.normals[c] / length)
                         : creased_normal(mesh, t, around[place_of(mesh.positions[c])]);
      const auto [place, is_new] = corners.try_emplace(
          {c, place_of(normal)}, static_cast<std::uint32_t>(result.positions.size()));
      if (is_new) {
        result.positions.push_back(mesh.positions[c]);
        result.normals.push_back(normal);
        result.uvs.push_back(mesh.uvs[c]);
      }
      triangle[i] = place->second;
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

// Makes the mesh of what was parsed, still in the file's axes.
class MeshMaker {
 public:
  MeshMaker(const tinyobj::ObjReader& object, std::string place)
      : attributes_(object.GetAttrib()),
        materials_(object.GetMaterials()),
        place_(std::move(place)) {
    std::size_t triangles = 0;
    for (const tinyobj::shape_t& shape : object.GetShapes()) {
      triangles += shape.mesh.indices.size() / 3;
    }
    if (triangles == 0 || triangles > kMaxTriangles) {
      throw Error("{}: {} triangles, expected 1 to {}", place_, triangles, kMaxTriangles);
    }
    for (const tinyobj::shape_t& shape : object.GetShapes()) add(shape.mesh);
    if (mesh_.triangles.empty()) throw Error("{}: nothing of it can be seen", place_);
  }

  [[nodiscard]] Mesh take() { return with_normals(mesh_); }

 private:
  using Key = std::array<int, 3>;

  void add(const tinyobj::mesh_t& part) {
    for (std::size_t t = 0; 3 * t + 2 < part.indices.size(); ++t) {
      const int material = t < part.material_ids.size() ? part.material_ids[t] : -1;
      const std::size_t id = material < 0 ? materials_.size() : static_cast<std::size_t>(material);
      if (id < materials_.size() && materials_[id].dissolve < kClear) continue;
      Mesh::Triangle triangle{};
      for (std::size_t i = 0; i < 3; ++i) triangle[i] = corner(part.indices[3 * t + i]);
      if (!triangles_.insert(places_of(triangle)).second) continue;
      mesh_.triangles.push_back(triangle);
      mesh_.materials.push_back(static_cast<MaterialId>(id));
    }
  }

  // The offset of item `index` in a list of `width` numbers per item.
  [[nodiscard]] std::size_t offset(int index, std::size_t width, std::size_t size) const {
    if (index < 0 || (static_cast<std::size_t>(index) + 1) * width > size) {
      throw Error("{}: a face names corner {} of {}", place_, index + 1, size / width);
    }
    return static_cast<std::size_t>(index) * width;
  }

  // A key that is equal for both sides of a triangle: some models have each triangle twice, once
  // per side, at the same depth.
  [[nodiscard]] std::array<Place, 3> places_of(const Mesh::Triangle& triangle) const {
    std::array<Place, 3> places;
    for (std::size_t i = 0; i < 3; ++i) places[i] = place_of(mesh_.positions[triangle[i]]);
    std::ranges::sort(places);
    return places;
  }

  std::uint32_t corner(const tinyobj::index_t& index) {
    const auto [place, is_new] =
        corners_.try_emplace(Key{index.vertex_index, index.texcoord_index, index.normal_index},
                             static_cast<std::uint32_t>(mesh_.positions.size()));
    if (!is_new) return place->second;
    const std::size_t v = offset(index.vertex_index, 3, attributes_.vertices.size());
    const float* p = attributes_.vertices.data() + v;
    mesh_.positions.emplace_back(p[0], p[1], p[2]);
    mesh_.uvs.emplace_back(0.F, 0.F);
    if (index.texcoord_index >= 0) {
      const std::size_t at = offset(index.texcoord_index, 2, attributes_.texcoords.size());
      // Files count from the picture's lower edge.
      mesh_.uvs.back() = {attributes_.texcoords[at], 1.F - attributes_.texcoords[at + 1]};
    }
    mesh_.normals.emplace_back(0.F, 0.F, 0.F);
    if (index.normal_index >= 0) {
      const std::size_t at = offset(index.normal_index, 3, attributes_.normals.size());
      const float* n = attributes_.normals.data() + at;
      mesh_.normals.back() = Eigen::Vector3f(n[0], n[1], n[2]);
    }
    if (!mesh_.positions.back().allFinite() || !mesh_.uvs.back().allFinite() ||
        !mesh_.normals.back().allFinite()) {
      throw Error("{}: a corner's numbers are not finite", place_);
    }
    return place->second;
  }

  const tinyobj::attrib_t& attributes_;
  const std::vector<tinyobj::material_t>& materials_;
  std::string place_;
  std::map<Key, std::uint32_t> corners_;
  std::set<std::array<Place, 3>> triangles_;  // triangles so far
  Mesh mesh_;
};

// The materials whose pictures must repeat beyond their edges.
std::vector<bool> repeating_materials(const Mesh& mesh, std::size_t materials) {
  constexpr float kEdge = 0.01F;
  std::vector<bool> repeats(materials, false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t corner : mesh.triangles[t]) {
      const Eigen::Vector2f& uv = mesh.uvs[corner];
      if (uv.minCoeff() < -kEdge || uv.maxCoeff() > 1.F + kEdge) {
        repeats[mesh.materials[t]] = true;
      }
    }
  }
  return repeats;
}

// The file's materials in its order, then one for triangles without a material.
MaterialLibrary load_materials(const AssetArchive& archive,
                               const std::string& folder,
                               const std::vector<tinyobj::material_t>& materials,
                               const std::vector<bool>& repeats) {
  MaterialLibrary library;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const std::string& picture = materials[i].diffuse_texname;
    if (picture.empty()) {
      library.add_plain(plain_color(materials[i].diffuse));
      continue;
    }
    const std::string bytes = archive.read(folder + picture, kMaxPictureBytes);
    const ColorImage color = decode_color(bytes, archive.place(folder + picture));
    library.add({MipTexture(shrunk(color.mat)), repeats[i]});
  }
  library.add_plain({200, 200, 200});
  return library;
}

// Transforms to axes x to the front, y left, z up and to the catalogue's size.
void place_on_floor(Mesh& mesh, const CatalogueEntry& entry, const std::string& place) {
  Eigen::Matrix3f axes;
  axes << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  const Eigen::Matrix3f turn = axes * entry.rotation.cast<float>();
  Eigen::AlignedBox3f box;
  for (Eigen::Vector3f& p : mesh.positions) box.extend(p = turn * p);
  const Eigen::Vector3f wanted =
      Eigen::Vector3d(entry.depth_m, entry.width_m, entry.height_m).cast<float>();
  if (!(box.sizes().minCoeff() > 0.F) || !box.sizes().allFinite()) {
    throw Error("{}: has no extent in some direction", place);
  }
  const Eigen::Vector3f scale = wanted.cwiseQuotient(box.sizes());
  const Eigen::Vector3f origin(box.center().x(), box.center().y(), box.min().z());
  for (Eigen::Vector3f& p : mesh.positions) p = scale.cwiseProduct(p - origin);
  for (Eigen::Vector3f& n : mesh.normals) {
    n = (turn * n).cwiseQuotient(scale).normalized();
  }
}

}  // namespace

AssetModel load_model(const AssetArchive& archive, const CatalogueEntry& entry) {
  const std::string place = archive.place(entry.model);
  const std::string folder = folder_of(entry.model);
  const std::string object = archive.read(entry.model, kMaxObjectBytes);
  tinyobj::ObjReaderConfig config;
  config.vertex_color = false;
  tinyobj::ObjReader reader;
  if (!reader.ParseFromString(object, material_text(archive, folder, object), config)) {
    throw Error("{}: not a readable OBJ file", place);
  }
  AssetModel model;
  model.name = entry.name;
  model.mesh = MeshMaker(reader, place).take();
  model.materials =
      load_materials(archive,
                     folder,
                     reader.GetMaterials(),
                     repeating_materials(model.mesh, reader.GetMaterials().size() + 1));
  place_on_floor(model.mesh, entry, place);
  return model;
}

Mesh add_model(const AssetModel& model, MaterialLibrary& materials) {
  const MaterialId first = static_cast<MaterialId>(materials.size());
  for (MaterialId id = 0; id < model.materials.size(); ++id) materials.add(model.materials[id]);
  Mesh mesh = model.mesh;
  for (MaterialId& id : mesh.materials) id += first;
  return mesh;
}

}  // namespace stillmap
