// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulation/scene/body.hpp"
#include "simulation/scene/flesh.hpp"
#include "simulation/scene/person_look.hpp"

namespace stillmap {

/// What covers a person, as layers of Flesh.
enum class PersonLayer : std::uint8_t { kSkin, kShirt, kTrousers, kShoes, kHair };

/// Which cylinder a part's pictures are wrapped round.
enum class PersonChart : std::uint8_t { kTrunk, kLeftArm, kRightArm, kLeftLeg, kRightLeg, kHead };
inline constexpr std::size_t kPersonCharts = 6;

/// Where the joints are, standing with the arms 18 degrees off the trunk.
[[nodiscard]] Skeleton person_skeleton(const PersonLook& look);

/// How high the pelvis joint of somebody is over the floor at rest.
[[nodiscard]] double rest_pelvis_height(const PersonLook& look);

/// The solid that person_skeleton() carries, in clothes; layers and charts as above.
[[nodiscard]] Flesh person_flesh(const PersonLook& look);

/// A person's body; adds what it is painted with to `materials`.
[[nodiscard]] Body make_person(const PersonLook& look, MaterialLibrary& materials);

}  // namespace stillmap
