// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "simulation/scene/asset_archive.hpp"
#include "simulation/scene/material.hpp"
#include "simulation/scene/mesh.hpp"

namespace stillmap {

/// A surface with its materials.
struct AssetModel {
  std::string name;
  Mesh mesh;  ///< material ids are positions in `materials`
  MaterialLibrary materials;
};

/// A model of an archive (Wavefront OBJ with its materials and JPEG or PNG pictures) in the size of
/// the catalogue: x to its front, y to its left, z up, its middle over the origin, its lowest point
/// at z = 0. Throws Error, naming archive and entry, for missing, damaged or too large parts.
[[nodiscard]] AssetModel load_model(const AssetArchive& archive, const CatalogueEntry& entry);

/// The surface of the model for a world with `materials`, to which those of the model are added.
[[nodiscard]] Mesh add_model(const AssetModel& model, MaterialLibrary& materials);

}  // namespace stillmap
