// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <Eigen/Geometry>

#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// Reads a trajectory in the TUM format: lines of `stamp tx ty tz qx qy qz qw`, camera to world,
/// metres. Quaternions are normalised.
///
/// Poses may be in any order and a stamp may occur twice, as both happen in published files (motion
/// capture that repeats a stamp, a recorder that writes late). As in the benchmark's own scripts,
/// the result is sorted by stamp and the last line of a stamp counts. Stamps of today's clock in
/// milliseconds or smaller units become seconds and keep their text. Throws Error with file and
/// line for another number of columns, a column that is no finite number, or a quaternion of length
/// zero; and for a file without poses.
[[nodiscard]] Trajectory read_trajectory(const std::filesystem::path& path);

/// A trajectory as a file has it.
struct ReadTrajectory {
  Trajectory poses;
  std::size_t equal_stamps = 0;   ///< poses that a later line with the same stamp replaced
  std::size_t rows_left_out = 0;  ///< those with a number that is not finite
};

/// read_trajectory() with what it says of the file; no row is left out.
[[nodiscard]] ReadTrajectory read_whole_trajectory(const std::filesystem::path& path);

/// read_trajectory() without the rows in which a number is not finite, as motion capture writes
/// where it does not see its markers.
[[nodiscard]] ReadTrajectory read_trajectory_with_gaps(const std::filesystem::path& path);

/// Poses sorted by stamp; of equal stamps the last counts.
[[nodiscard]] ReadTrajectory sorted_by_stamp(Trajectory poses);

/// The pose of numbers in a file, the quaternion normalised. Throws Error, beginning with `place`,
/// for a position beyond 1e9 m and a quaternion whose length is far from 1.
[[nodiscard]] Eigen::Isometry3d checked_pose(const Eigen::Vector3d& t,
                                             const Eigen::Quaterniond& q,
                                             const std::string& place);
/// Throws Error, beginning with `place`, for a position beyond 1e9 m: squares and sums would lose
/// their precision.
void check_position(const Eigen::Vector3d& t, const std::string& place);

/// A trajectory in the TUM format. Stamps keep their text; numbers have 7 decimals (0.1
/// micrometres), so that the same poses give the same bytes.
[[nodiscard]] std::string format_trajectory(const Trajectory& trajectory);

}  // namespace stillmap
