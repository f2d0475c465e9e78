// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <CLI/CLI.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/sensor/associate.hpp"

namespace stillmap {

// The parts of `stillmap evaluate`.
void add_evaluate_trajectory(CLI::App& evaluate);
void add_evaluate_map(CLI::App& evaluate);
void add_evaluate_residue(CLI::App& evaluate);

struct TrajectoryFile {
  std::string file;
  Trajectory poses;
  std::size_t equal_stamps = 0;  ///< poses that a later line with the same stamp replaced
};

/// Reads a trajectory of any format: see read_any_trajectory().
[[nodiscard]] TrajectoryFile read_trajectory_file(const std::string& file);

/// T_groundtruth_estimate of a map (see map_alignment). Throws Error, naming both files, when too
/// few stamps agree.
[[nodiscard]] Eigen::Isometry3d required_alignment(const TrajectoryFile& groundtruth,
                                                   const TrajectoryFile& estimate);

/// The message for too few stamps that agree.
[[nodiscard]] Error too_few_pairs(const TrajectoryFile& groundtruth,
                                  const TrajectoryFile& estimate,
                                  double max_difference_s = kMaxStampDifferenceS);

}  // namespace stillmap
