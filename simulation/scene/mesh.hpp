// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "simulation/scene/material.hpp"

namespace stillmap {

/// A surface of triangles with a picture on each. Positions in metres, in the frame of the owner of
/// the surface.
struct Mesh {
  using Triangle = std::array<std::uint32_t, 3>;  ///< indices of corners

  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;  ///< unit, one a position, for smooth shading
  std::vector<Eigen::Vector2f> uvs;      ///< place on the material's picture, one a position
  std::vector<Triangle> triangles;       ///< counter-clockwise as seen from outside
  std::vector<MaterialId> materials;     ///< one a triangle

  /// Adds another surface, moved by `T_mesh_part`.
  void append(const Mesh& part, const Eigen::Isometry3d& T_mesh_part);
};

/// Normals of the corners: of the triangles around each, weighted by area. For surfaces that are
/// smooth everywhere; a corner of a box belongs to three positions, one a face.
[[nodiscard]] std::vector<Eigen::Vector3f> smooth_normals(
    const std::vector<Eigen::Vector3f>& positions, const std::vector<Mesh::Triangle>& triangles);

}  // namespace stillmap
