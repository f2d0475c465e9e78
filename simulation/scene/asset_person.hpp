// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "simulation/scene/asset_model.hpp"
#include "simulation/scene/body.hpp"

namespace stillmap {

/// A model of a person with the positions of its joints.
struct PersonAsset {
  AssetModel model;   ///< in the frame of the pelvis joint
  Skeleton skeleton;  ///< in the posture of the model; its limbs may be bent
};

/// The people of the Reallusion library of Sweet Home 3D that can walk and sit: the standing ones
/// in trousers.
[[nodiscard]] std::vector<PersonAsset> load_people(const AssetArchive& archive);

/// The person for a world with `materials`, to which those of the model are added.
[[nodiscard]] Body make_person(const PersonAsset& asset, MaterialLibrary& materials);

}  // namespace stillmap
