// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/core/trajectory.hpp"

namespace stillmap {

// What `stillmap evaluate` is made of.
void add_evaluate_map(CLI::App& evaluate);
void add_evaluate_residue(CLI::App& evaluate);

struct TrajectoryFile {
  std::string file;
  Trajectory poses;
};

[[nodiscard]] TrajectoryFile read_trajectory_file(const std::string& file);

/// T_groundtruth_estimate for a map (see map_alignment). Throws Error, naming both files, where too
/// few stamps agree.
[[nodiscard]] Eigen::Isometry3d required_alignment(const TrajectoryFile& groundtruth,
                                                   const TrajectoryFile& estimate);

/// What is said when too few stamps agree.
[[nodiscard]] Error too_few_pairs(const TrajectoryFile& groundtruth,
                                  const TrajectoryFile& estimate);

}  // namespace stillmap
