// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "simulation/scene/assets.hpp"
#include "simulation/scene/world.hpp"

namespace stillmap {

/// An office of 6 x 6 x 2.7 m without people, centred on the world's z axis: walls with posters and
/// blank stretches, desks with monitors, keyboards, books and mugs, chairs, a shelf, lamps. Its
/// layout is fixed; `seed` varies its pictures. Things that may be moved: "chair_1" and "chair_2"
/// (ids 10 and 11) at their desks, "chair_3" (12) in the middle, the carton "box_1" (13). The
/// chairs are those of `assets` where it has some.
[[nodiscard]] World make_office(std::uint32_t seed, const Assets* assets = nullptr);

}  // namespace stillmap
