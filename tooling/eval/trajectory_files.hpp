// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "stillmap/io/trajectory_io.hpp"

namespace stillmap {

/// Reads a trajectory in one of three formats, told apart by the first row:
/// - TUM: see read_trajectory();
/// - EuRoC: `stamp,x,y,z,qw,qx,qy,qz[,...]`, commas between the columns, the stamp in nanoseconds;
/// - KITTI: the 12 numbers of a pose's first three rows. It has no stamps: row n, counted from 0,
///   is of n / 10 s, as KITTI records ten frames a second.
///
/// Throws Error with file and line for rows of another form, and for a file without poses.
[[nodiscard]] ReadTrajectory read_any_trajectory(const std::filesystem::path& path);

}  // namespace stillmap
