// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/evaluate.hpp"

#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/sensor/associate.hpp"
#include "stillmap/sensor/sequence.hpp"
#include "tooling/eval/ate.hpp"
#include "tooling/eval/map_alignment.hpp"
#include "tooling/eval/metrics_json.hpp"
#include "tooling/eval/rpe.hpp"

namespace stillmap {
namespace {

struct TrajectoryArguments {
  std::string groundtruth;
  std::string estimate;
  std::string sequence;
  bool json = false;
};

struct TrajectoryFigures {
  AteResult ate;
  std::optional<RpeResult> rpe;  // nothing if the estimate is too short
  std::size_t tracked = 0;
  std::optional<std::size_t> frames;  // known only with a sequence
};

TrajectoryFigures measure(const TrajectoryArguments& arguments) {
  const TrajectoryFile groundtruth = read_trajectory_file(arguments.groundtruth);
  const TrajectoryFile estimate = read_trajectory_file(arguments.estimate);
  TrajectoryFigures figures;
  std::optional<AteResult> ate = absolute_trajectory_error(groundtruth.poses, estimate.poses);
  if (!ate) throw too_few_pairs(groundtruth, estimate);
  figures.ate = std::move(*ate);
  figures.rpe = relative_pose_error(groundtruth.poses, estimate.poses);
  figures.tracked = estimate.poses.size();
  if (!arguments.sequence.empty()) {
    figures.frames = Sequence::open(arguments.sequence).size();
    if (figures.tracked > *figures.frames) {
      throw Error("{}: {} poses, but {} has only {} frames; is it of this sequence?",
                  arguments.estimate,
                  figures.tracked,
                  arguments.sequence,
                  *figures.frames);
    }
  }
  return figures;
}

nlohmann::ordered_json as_json(const TrajectoryFigures& figures) {
  nlohmann::ordered_json json = {{"ate", ate_json(figures.ate)}, {"rpe", rpe_json(figures.rpe)}};
  if (figures.frames) json["frames"] = frames_json(*figures.frames, figures.tracked);
  return json;
}

std::string row(const char* name, const Statistics& s, int decimals) {
  return fmt::format("{:<20} {:>10.{}f} {:>10.{}f} {:>10.{}f} {:>10.{}f} {:>10.{}f}\n",
                     name,
                     s.rmse,
                     decimals,
                     s.mean,
                     decimals,
                     s.median,
                     decimals,
                     s.std,
                     decimals,
                     s.max,
                     decimals);
}

std::string as_table(const TrajectoryFigures& figures) {
  std::string text = fmt::format(
      "{:<20} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "", "rmse", "mean", "median", "std", "max");
  text += row("ATE (m)", figures.ate.translation_m, 6);
  if (figures.rpe) {
    text += row("RPE (m per s)", figures.rpe->translation_m, 6);
    text += row("RPE (deg per s)", figures.rpe->rotation_deg, 6);
  }
  text += fmt::format("\nATE over {} pairs, ", figures.ate.pairs.size());
  text += figures.rpe ? fmt::format("RPE over {} pairs\n", figures.rpe->pairs)
                      : std::string("no RPE: no two poses 1 s apart with ground truth\n");
  if (figures.frames) {
    text += fmt::format(
        "tracked {} of {} frames ({:.1f} %)\n",
        figures.tracked,
        *figures.frames,
        100.0 * static_cast<double>(figures.tracked) / static_cast<double>(*figures.frames));
  }
  return text;
}

void add_trajectory(CLI::App& evaluate) {
  const std::shared_ptr<TrajectoryArguments> arguments = std::make_shared<TrajectoryArguments>();
  CLI::App& command = *evaluate.add_subcommand(
      "trajectory", "Errors of a trajectory against ground truth, as in the TUM benchmark");
  command.add_option("GT", arguments->groundtruth, "ground truth, TUM format")->required();
  command.add_option("EST", arguments->estimate, "estimated trajectory, TUM format")->required();
  command.add_option(
      "--sequence", arguments->sequence, "folder of the sequence, for the share of tracked frames");
  command.add_flag("--json", arguments->json, "print JSON and nothing else");
  command.callback([arguments] {
    const TrajectoryFigures figures = measure(*arguments);
    print_output(arguments->json ? as_json(figures).dump(2) + "\n" : as_table(figures));
  });
}

}  // namespace

TrajectoryFile read_trajectory_file(const std::string& file) {
  return {file, read_trajectory(file)};
}

Error too_few_pairs(const TrajectoryFile& groundtruth, const TrajectoryFile& estimate) {
  return Error(
      "{}: fewer than 3 poses are within {} s of one in {}; are both of the same sequence?",
      estimate.file,
      kMaxStampDifferenceS,
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
  add_trajectory(evaluate);
  add_evaluate_map(evaluate);
  add_evaluate_residue(evaluate);
}

}  // namespace stillmap
