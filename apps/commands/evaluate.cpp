// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/evaluate.hpp"

#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include "apps/commands.hpp"
#include "stillmap/core/error.hpp"
#include "tooling/eval/map_alignment.hpp"
#include "tooling/eval/trajectory_files.hpp"

namespace stillmap {

TrajectoryFile read_trajectory_file(const std::string& file) {
  ReadTrajectory read = read_any_trajectory(file);
  return {file, std::move(read.poses), read.equal_stamps};
}

Error too_few_pairs(const TrajectoryFile& groundtruth,
                    const TrajectoryFile& estimate,
                    double max_difference_s) {
  return Error(
      "{}: fewer than 3 poses are within {} s of one in {}; are both of the same sequence?",
      estimate.file,
      max_difference_s,
      groundtruth.file);
}

Eigen::Isometry3d required_alignment(const TrajectoryFile& groundtruth,
                                     const TrajectoryFile& estimate) {
  const std::optional<Eigen::Isometry3d> T = map_alignment(groundtruth.poses, estimate.poses);
  if (!T) throw too_few_pairs(groundtruth, estimate);
  return *T;
}

void add_evaluate_command(CLI::App& app, CommandResult&) {
  CLI::App& evaluate =
      *app.add_subcommand("evaluate", "Compare results with truth")->require_subcommand(1);
  add_evaluate_trajectory(evaluate);
  add_evaluate_map(evaluate);
  add_evaluate_residue(evaluate);
}

}  // namespace stillmap
