// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tooling/export/observed_space.hpp"

namespace stillmap {

/// kBinary: OctoMap's .bt, occupied or free. kFull: its .ot, with probabilities.
enum class OctreeFormat { kBinary, kFull };

/// An OctoMap file of observed space, with the tree type `OcTree`: that is what octomap_server,
/// MoveIt and octovis read; a ColorOcTree only octovis does without being rebuilt.
///
/// Probabilities are those of OctoMap's sensor model, one hit (0.7) or miss (0.4) for each camera
/// that saw the voxel, within its bounds 0.12 and 0.97; an occupied voxel counts at least one hit.
[[nodiscard]] std::string encode_octree(const ObservedSpace& space, OctreeFormat format);

}  // namespace stillmap
