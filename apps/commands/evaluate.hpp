// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "stillmap/core/trajectory.hpp"
#include "stillmap/eval/ate.hpp"

namespace stillmap {

// What `stillmap evaluate` is made of.
void add_evaluate_map(CLI::App& evaluate);
void add_evaluate_residue(CLI::App& evaluate);

struct TrajectoryFile {
  std::string file;
  Trajectory poses;
};

[[nodiscard]] TrajectoryFile read_trajectory_file(const std::string& file);

/// The error of an estimate. Throws Error, naming both files, where too few stamps agree.
[[nodiscard]] AteResult required_ate(const TrajectoryFile& groundtruth,
                                     const TrajectoryFile& estimate);

}  // namespace stillmap
