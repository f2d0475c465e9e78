// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "simulation/scene/asset_model.hpp"
#include "simulation/scene/body.hpp"

namespace stillmap {

/// A model of somebody and where the joints in it are.
struct PersonAsset {
  AssetModel model;   ///< in the frame of the pelvis joint
  Skeleton skeleton;  ///< as the model stands; its limbs may be bent
};

/// The people of Sweet Home 3D's Reallusion library that can be made to walk and sit: those that
/// stand, in trousers.
[[nodiscard]] std::vector<PersonAsset> load_people(const AssetArchive& archive);

/// Somebody for a world with these materials, to which the model's are added.
[[nodiscard]] Body make_person(const PersonAsset& asset, MaterialLibrary& materials);

}  // namespace stillmap
