// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tooling/export/observed_space.hpp"

namespace stillmap {

/// kBinary: .bt of OctoMap, occupied or free. kFull: .ot of OctoMap, with probabilities.
enum class OctreeFormat { kBinary, kFull };

/// Observed space as an OctoMap file with the tree type `OcTree`, which octomap_server, MoveIt and
/// octovis read. Only octovis reads a ColorOcTree without being rebuilt.
///
/// Probabilities follow the sensor model of OctoMap: one hit (0.7) or miss (0.4) for each camera
/// that saw the voxel, clamped to 0.12 and 0.97. An occupied voxel has at least one hit.
[[nodiscard]] std::string encode_octree(const ObservedSpace& space, OctreeFormat format);

}  // namespace stillmap
