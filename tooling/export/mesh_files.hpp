// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tooling/export/surface_mesh.hpp"

namespace stillmap {

/// A mesh as binary little-endian PLY: for each vertex `float x y z nx ny nz`, `uchar red green
/// blue label`; for each face `list uchar int vertex_indices`.
[[nodiscard]] std::string encode_mesh_ply(const SurfaceMesh& mesh);

/// A mesh as Wavefront OBJ: `v x y z r g b` with colours from 0 to 1, as many programs read them,
/// `vn`, and one group `label_N` for the triangles of each label in it. The label of a triangle is
/// that of its first vertex.
[[nodiscard]] std::string encode_mesh_obj(const SurfaceMesh& mesh);

/// A mesh as binary glTF 2.0 with the attributes POSITION, NORMAL, COLOR_0 (linear, as glTF asks)
/// and, for the label, _LABEL. Its node turns the map's frame, in which y points down at the start
/// of a run, into glTF's, in which y points up.
[[nodiscard]] std::string encode_mesh_glb(const SurfaceMesh& mesh);

/// In the format that the suffix of `file` names: .ply, .obj or .glb. Throws Error for another.
[[nodiscard]] std::string encode_mesh(const SurfaceMesh& mesh, const std::filesystem::path& file);

}  // namespace stillmap
