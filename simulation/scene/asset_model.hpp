// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "simulation/scene/asset_archive.hpp"
#include "simulation/scene/material.hpp"
#include "simulation/scene/mesh.hpp"

namespace stillmap {

/// A surface and what is on it.
struct AssetModel {
  std::string name;
  Mesh mesh;  ///< materials are places in `materials`
  MaterialLibrary materials;
};

/// A model of an archive (Wavefront OBJ with its materials and JPEG or PNG pictures) in the size
/// that the catalogue gives: x to its front, y to its left, z up, its middle over the origin, its
/// lowest point at z = 0. An Error names the archive and the entry where something is missing,
/// damaged or too large.
[[nodiscard]] AssetModel load_model(const AssetArchive& archive, const CatalogueEntry& entry);

/// The model's surface for a world with these materials, to which its own are added.
[[nodiscard]] Mesh add_model(const AssetModel& model, MaterialLibrary& materials);

}  // namespace stillmap
