// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// Writes poses as `stamp tx ty tz qx qy qz qw`, one a line, camera to world, metres (the format of
/// the TUM RGB-D benchmark). The file is written whole or not at all. Throws Error naming it.
void save_trajectory(const std::filesystem::path& file, const Trajectory& trajectory);

/// Writes a point cloud as binary PLY: x, y, z, red, green, blue, label, and normals where it has
/// them. The file is written whole or not at all. Throws Error naming it.
void save_map(const std::filesystem::path& file, const PointCloud& map);

}  // namespace stillmap
