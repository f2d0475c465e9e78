// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulation/scene/body.hpp"
#include "simulation/scene/flesh.hpp"
#include "simulation/scene/person_look.hpp"

namespace stillmap {

/// The clothes of a person, as layers of Flesh.
enum class PersonLayer : std::uint8_t { kSkin, kShirt, kTrousers, kShoes, kHair };

/// The cylinder around which the pictures of a part are wrapped.
enum class PersonChart : std::uint8_t { kTrunk, kLeftArm, kRightArm, kLeftLeg, kRightLeg, kHead };
inline constexpr std::size_t kPersonCharts = 6;

/// The joints of a standing person, with the arms 18 degrees off the trunk.
[[nodiscard]] Skeleton person_skeleton(const PersonLook& look);

/// The height of the pelvis joint over the floor at rest.
[[nodiscard]] double rest_pelvis_height(const PersonLook& look);

/// The solid that person_skeleton() carries, in clothes; layers and charts as above.
[[nodiscard]] Flesh person_flesh(const PersonLook& look);

/// A person's body; adds its materials to `materials`.
[[nodiscard]] Body make_person(const PersonLook& look, MaterialLibrary& materials);

}  // namespace stillmap
