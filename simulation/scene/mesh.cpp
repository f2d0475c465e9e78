// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/mesh.hpp"

namespace stillmap {

void Mesh::append(const Mesh& part, const Eigen::Isometry3d& T_mesh_part) {
  const std::uint32_t first = static_cast<std::uint32_t>(positions.size());
  const Eigen::Isometry3f T = T_mesh_part.cast<float>();
  for (const Eigen::Vector3f& p : part.positions) positions.push_back(T * p);
  for (const Eigen::Vector3f& n : part.normals) normals.push_back(T.linear() * n);
  uvs.insert(uvs.end(), part.uvs.begin(), part.uvs.end());
  for (const Triangle& t : part.triangles) {
    triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  materials.insert(materials.end(), part.materials.begin(), part.materials.end());
}

std::vector<Eigen::Vector3f> smooth_normals(const std::vector<Eigen::Vector3f>& positions,
                                            const std::vector<Mesh::Triangle>& triangles) {
  std::vector<Eigen::Vector3f> normals(positions.size(), Eigen::Vector3f::Zero());
  for (const Mesh::Triangle& t : triangles) {
    const Eigen::Vector3f& a = positions[t[0]];
    const Eigen::Vector3f twice_area = (positions[t[1]] - a).cross(positions[t[2]] - a);
    for (const std::uint32_t corner : t) normals[corner] += twice_area;
  }
  for (Eigen::Vector3f& n : normals) n = n.norm() > 0 ? n.normalized() : Eigen::Vector3f::UnitZ();
  return normals;
}

}  // namespace stillmap
