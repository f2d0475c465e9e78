// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/commands/evaluate.hpp"
#include "apps/sensor_camera.hpp"
#include "apps/sequence_option.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/sensor/sequence.hpp"
#include "tooling/eval/map_files.hpp"
#include "tooling/eval/map_quality.hpp"
#include "tooling/eval/metrics_json.hpp"
#include "tooling/eval/pose_at.hpp"
#include "tooling/eval/see_through.hpp"

namespace stillmap {
namespace {

struct ResidueArguments {
  std::string run;
  SequenceArguments sequence;
  std::string groundtruth;
  bool json = false;
};

/// The map and the poses of the frames that test it, in one world frame.
struct PosedSequence {
  PointCloud map;
  std::map<std::uint32_t, Eigen::Isometry3d> T_world_camera;  ///< of frames
};

// With the camera of the run. Runs of earlier versions did not keep it.
Sequence sequence_of(const ResidueArguments& arguments) {
  SequenceArguments sequence = arguments.sequence;
  const std::filesystem::path camera = std::filesystem::path(arguments.run) / "camera.yaml";
  if (std::filesystem::exists(camera)) sequence.camera = camera.string();
  return open_sequence(sequence);
}

// The frames that the run tracked, in its world frame.
PosedSequence as_estimated(PointCloud map,
                           const Sequence& sequence,
                           const TrajectoryFile& estimate) {
  std::map<std::string, std::uint32_t> frame_of;
  for (std::uint32_t i = 0; i < sequence.size(); ++i) {
    frame_of[sequence.entry(FrameId(i)).stamp.text] = i;
  }
  PosedSequence posed{.map = std::move(map), .T_world_camera = {}};
  for (const StampedPose& pose : estimate.poses) {
    const auto found = frame_of.find(pose.stamp.text);
    if (found == frame_of.end()) {
      throw Error("{}: {} has no frame of the stamp {}; is the run of this sequence?",
                  estimate.file,
                  sequence.path().string(),
                  pose.stamp.text);
    }
    posed.T_world_camera[found->second] = pose.T_world_camera;
  }
  return posed;
}

// All frames with true poses, in the world frame of the truth.
PosedSequence as_true(const PointCloud& map,
                      const Sequence& sequence,
                      const TrajectoryFile& groundtruth,
                      const TrajectoryFile& estimate) {
  PosedSequence posed{.map = moved(map, required_alignment(groundtruth, estimate)),
                      .T_world_camera = {}};
  check_extent(posed.map, "the map, moved to " + groundtruth.file);
  for (std::uint32_t i = 0; i < sequence.size(); ++i) {
    const double stamp_s = sequence.entry(FrameId(i)).stamp.seconds;
    const std::optional<Eigen::Isometry3d> pose = pose_at(groundtruth.poses, stamp_s);
    if (pose) posed.T_world_camera[i] = *pose;
  }
  return posed;
}

Residue measure(const ResidueArguments& arguments) {
  const std::filesystem::path run = arguments.run;
  const TrajectoryFile estimate = read_trajectory_file((run / "trajectory.txt").string());
  PointCloud map = read_map(run / "map.ply");
  Sequence sequence = sequence_of(arguments);
  sequence.use_camera(sensor_camera(sequence, {}, std::nullopt).camera);
  // With ground truth, too, to check that the run is of this sequence.
  PosedSequence posed = as_estimated(std::move(map), sequence, estimate);
  if (!arguments.groundtruth.empty()) {
    posed = as_true(posed.map, sequence, read_trajectory_file(arguments.groundtruth), estimate);
  }
  SeeThroughTest test(sequence.camera(), std::move(posed.map.positions));
  for (const auto& [frame, T_world_camera] : posed.T_world_camera) {
    test.add(sequence.read(FrameId(frame))->depth, T_world_camera);
  }
  return test.result();
}

void evaluate_residue(const ResidueArguments& arguments) {
  const Residue residue = measure(arguments);
  if (arguments.json) {
    const nlohmann::ordered_json json = {{"residue", residue_json(residue)}};
    print_output(json.dump(2) + "\n");
    return;
  }
  print_output(fmt::format(
      "residue     {:.4f} %\n{} of {} points are seen through by at least {} of {} frames\n"
      "noise floor {:.4f} %\n{} of these points are surface that as many frames measure\n",
      100 * residue.ratio(),
      residue.seen_through,
      residue.points,
      kSeeThroughFrames,
      residue.frames,
      100 * residue.noise_floor(),
      residue.by_noise));
}

}  // namespace

void add_evaluate_residue(CLI::App& evaluate) {
  const std::shared_ptr<ResidueArguments> arguments = std::make_shared<ResidueArguments>();
  CLI::App& command = *evaluate.add_subcommand(
      "residue", "The share of a map that its own depth images see through; needs no truth");
  command.add_option("RUN", arguments->run, "folder of the run")->required();
  add_sequence_options(command, arguments->sequence);
  command.add_option("--groundtruth",
                     arguments->groundtruth,
                     "true trajectory: tests with all frames of the sequence, at their true poses");
  command.add_flag("--json", arguments->json, "print JSON and nothing else");
  command.callback([arguments] { evaluate_residue(*arguments); });
}

}  // namespace stillmap
