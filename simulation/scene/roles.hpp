// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "simulation/scene/actor.hpp"
#include "simulation/scene/world.hpp"

namespace stillmap {

/// A thing that a person moves.
struct ThingRole {
  std::string thing;
  ThingMotion T_world_thing;
};

/// The roles, one per person in the order of their numbers, and the things that they move.
struct Play {
  std::vector<Role> roles;
  std::vector<ThingRole> things;
};

/// The thing of that name. Throws Error if the world has none.
[[nodiscard]] const Thing& thing_named(const World& world, const std::string& name);

/// Two people who talk at their desks.
[[nodiscard]] Play sitting_play(const World& office);

/// Three people who walk. Their motion depends only on time and the initial poses of the things.
[[nodiscard]] Play walking_play(const World& office);

}  // namespace stillmap
