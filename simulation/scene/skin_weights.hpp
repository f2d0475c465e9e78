// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "simulation/scene/body.hpp"

namespace stillmap {

/// The parent of each joint; the pelvis is its own.
inline constexpr std::array<std::size_t, kJoints> kJointParents = {
    0, 0, 1, 2, 3, 2, 5, 6, 2, 8, 9, 0, 11, 12, 0, 14, 15};

/// The weights of the joints that a vertex follows; their sum is 1.
using JointWeights = std::array<float, kJoints>;

/// For a surface whose limbs are apart from one another: each corner follows the bone that is
/// nearest and its neighbours.
[[nodiscard]] std::vector<JointWeights> weights_by_distance(const Mesh& rest,
                                                            const Skeleton& skeleton);

/// For a surface whose limbs may touch each other or the trunk at rest: a vertex follows the
/// nearest bone to which it is connected along the surface, and neighbouring vertices follow
/// similar bones, so that cloth between the limbs does not tear.
[[nodiscard]] std::vector<JointWeights> weights_along_surface(const Mesh& rest,
                                                              const Skeleton& skeleton);

}  // namespace stillmap
