// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// Reads a trajectory in the TUM format: `stamp tx ty tz qx qy qz qw` a line, camera to world,
/// metres; quaternions are normalised.
///
/// Poses may come in any order and a stamp may come twice, as both occur in published files (a
/// motion capture that repeats a stamp, a recorder that writes late): as in the benchmark's own
/// scripts, the result is sorted by stamp and the last line of a stamp counts.
/// Throws Error with file and line for other numbers of columns, what is not a finite number, or a
/// quaternion of length zero; and for a file without poses.
[[nodiscard]] Trajectory read_trajectory(const std::filesystem::path& path);

/// The TUM format of a trajectory. Stamps are repeated by their text, numbers have 7 decimals
/// (0.1 micrometres, finer than any truth), so that the same poses give the same bytes.
[[nodiscard]] std::string format_trajectory(const Trajectory& trajectory);

}  // namespace stillmap
