// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/commands/evaluate.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/core/parse_number.hpp"
#include "stillmap/sensor/sequence.hpp"
#include "tooling/eval/ate.hpp"
#include "tooling/eval/metrics_json.hpp"
#include "tooling/eval/rpe.hpp"

namespace stillmap {
namespace {

constexpr const char* kFit = "fit";

struct TrajectoryArguments {
  std::string groundtruth;
  std::string estimate;
  std::string sequence;
  double max_difference_s = kMaxStampDifferenceS;
  double offset_s = 0;
  std::string scale = "1";  // or kFit
  bool interpolate = false;
  bool json = false;
};

struct TrajectoryFigures {
  AteResult ate;
  std::optional<RpeResult> rpe;  // nothing if the estimate is too short
  double scale = 1;
  std::size_t tracked = 0;
  std::optional<std::size_t> frames;  // known only with a sequence
  std::vector<std::string> warnings;
};

// The scale that is asked for; nothing for the one that fits.
std::optional<double> given_scale(const std::string& text) {
  if (text == kFit) return std::nullopt;
  const std::optional<double> scale = parse_number<double>(text);
  if (!scale || !std::isfinite(*scale) || *scale <= 0) {
    throw Error("--scale {}: expected a positive number or '{}'", text, kFit);
  }
  return scale;
}

void move_stamps(Trajectory& poses, double offset_s) {
  for (StampedPose& pose : poses) pose.stamp.seconds += offset_s;
}

void scale_positions(Trajectory& poses, double scale) {
  for (StampedPose& pose : poses) pose.T_world_camera.translation() *= scale;
}

double scale_of(const TrajectoryArguments& arguments,
                const TrajectoryFile& groundtruth,
                const TrajectoryFile& estimate) {
  if (const std::optional<double> given = given_scale(arguments.scale)) return *given;
  const std::optional<double> fitted =
      fitted_scale(groundtruth.poses, estimate.poses, arguments.max_difference_s);
  if (!fitted) {
    throw Error("{}: --scale {}: fewer than 3 pairs, or no motion like that of {}",
                estimate.file,
                kFit,
                groundtruth.file);
  }
  return *fitted;
}

std::size_t frames_in(const TrajectoryArguments& arguments, std::size_t tracked) {
  const SequenceOptions as_it_looks;
  const std::size_t frames = Sequence::open(arguments.sequence, as_it_looks).size();
  if (tracked > frames) {
    throw Error("{}: {} poses, but {} has only {} frames; is it of this sequence?",
                arguments.estimate,
                tracked,
                arguments.sequence,
                frames);
  }
  return frames;
}

std::vector<std::string> warnings_of(const TrajectoryArguments& arguments,
                                     const TrajectoryFile& groundtruth,
                                     const TrajectoryFile& estimate) {
  std::vector<std::string> warnings;
  for (const TrajectoryFile* const file : {&groundtruth, &estimate}) {
    if (file->equal_stamps == 0) continue;
    warnings.push_back(
        fmt::format("{}: {} poses have the stamp of a later line, which replaces them",
                    file->file,
                    file->equal_stamps));
  }
  const double distance_s = groundtruth_distance_s(groundtruth.poses, estimate.poses);
  if (!arguments.interpolate && distance_s >= arguments.max_difference_s) {
    warnings.push_back(
        fmt::format("{}: too few poses for RPE, which compares with poses up to {:.3f} s away; "
                    "--interpolate takes those in between",
                    groundtruth.file,
                    distance_s));
  }
  return warnings;
}

TrajectoryFigures measure(const TrajectoryArguments& arguments) {
  const TrajectoryFile groundtruth = read_trajectory_file(arguments.groundtruth);
  TrajectoryFile estimate = read_trajectory_file(arguments.estimate);
  move_stamps(estimate.poses, arguments.offset_s);
  TrajectoryFigures figures;
  figures.scale = scale_of(arguments, groundtruth, estimate);
  scale_positions(estimate.poses, figures.scale);
  std::optional<AteResult> ate =
      absolute_trajectory_error(groundtruth.poses, estimate.poses, arguments.max_difference_s);
  if (!ate) throw too_few_pairs(groundtruth, estimate, arguments.max_difference_s);
  figures.ate = std::move(*ate);
  figures.rpe = arguments.interpolate
                    ? interpolated_relative_pose_error(groundtruth.poses, estimate.poses)
                    : relative_pose_error(groundtruth.poses, estimate.poses);
  figures.tracked = estimate.poses.size();
  if (!arguments.sequence.empty()) figures.frames = frames_in(arguments, figures.tracked);
  figures.warnings = warnings_of(arguments, groundtruth, estimate);
  return figures;
}

nlohmann::ordered_json as_json(const TrajectoryFigures& figures) {
  nlohmann::ordered_json json = {{"ate", ate_json(figures.ate)}, {"rpe", rpe_json(figures.rpe)}};
  if (figures.scale != 1) json["scale"] = figures.scale;
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
  if (figures.scale != 1) text += fmt::format("estimate scaled by {:.6f}\n", figures.scale);
  if (figures.frames) {
    text += fmt::format(
        "tracked {} of {} frames ({:.1f} %)\n",
        figures.tracked,
        *figures.frames,
        100.0 * static_cast<double>(figures.tracked) / static_cast<double>(*figures.frames));
  }
  return text;
}

void evaluate_trajectory(const TrajectoryArguments& arguments) {
  const TrajectoryFigures figures = measure(arguments);
  for (const std::string& warning : figures.warnings) {
    fmt::print(stderr, "stillmap: warning: {}\n", warning);
  }
  print_output(arguments.json ? as_json(figures).dump(2) + "\n" : as_table(figures));
}

}  // namespace

void add_evaluate_trajectory(CLI::App& evaluate) {
  const std::shared_ptr<TrajectoryArguments> arguments = std::make_shared<TrajectoryArguments>();
  CLI::App& command = *evaluate.add_subcommand(
      "trajectory", "Errors of a trajectory against ground truth, as in the TUM benchmark");
  command
      .add_option("GT", arguments->groundtruth, "ground truth: TUM, EuRoC (CSV) or KITTI format")
      ->required();
  command.add_option("EST", arguments->estimate, "estimated trajectory, in any of these formats")
      ->required();
  command.add_option(
      "--sequence", arguments->sequence, "folder of the sequence, for the share of tracked frames");
  command
      .add_option("--max-diff",
                  arguments->max_difference_s,
                  "for ATE: poses with stamps less than this apart are pairs, seconds")
      ->check(CLI::Range(1e-6, 10.0))
      ->capture_default_str();
  command.add_option("--offset", arguments->offset_s, "added to the stamps of EST, seconds")
      ->check(CLI::Range(-1e10, 1e10))
      ->capture_default_str();
  command
      .add_option("--scale",
                  arguments->scale,
                  "of the positions of EST: a factor, or 'fit' for the one with the least ATE")
      ->capture_default_str();
  command.add_flag("--interpolate",
                   arguments->interpolate,
                   "for RPE: ground truth between its poses, at the stamps of EST");
  command.add_flag("--json", arguments->json, "print JSON and nothing else");
  command.callback([arguments] { evaluate_trajectory(*arguments); });
}

}  // namespace stillmap
