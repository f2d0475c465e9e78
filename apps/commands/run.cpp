// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "apps/commands.hpp"
#include "apps/image_names.hpp"
#include "apps/option_value.hpp"
#include "apps/run_progress.hpp"
#include "apps/run_summary.hpp"
#include "apps/steady_clock.hpp"
#include "apps/version.hpp"
#include "stillmap/config/config_io.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/sensor/tum_folder.hpp"
#include "stillmap/session/session_io.hpp"
#include "tooling/eval/ate.hpp"
#include "tooling/eval/rpe.hpp"
#include "tooling/pipeline/inpainted_folder.hpp"
#include "tooling/pipeline/map_evaluation.hpp"
#include "tooling/pipeline/object_folder.hpp"
#include "tooling/pipeline/run_folder.hpp"
#include "tooling/pipeline/run_sequence.hpp"

namespace stillmap {
namespace {

constexpr int kLostForGood = 3;

struct RunArguments {
  std::string sequence;
  std::string out;
  std::string config_file;
  std::vector<std::string> settings;
  std::string camera;
  std::string segmenter;  // empty: auto where its networks are, else none
  std::string dynamics;   // empty: as configured
  std::string frames;
  std::size_t stride = 1;
  int threads = 2;
  bool live = false;
  double speed = 1;
  std::string replay;
  std::string load;
  bool localize_only = false;
  std::string groundtruth;
  std::string poses = "estimated";
  std::string objects_out;
  std::string inpainted;
};

SystemConfig make_config(const RunArguments& arguments) {
  SystemConfig config;
  const std::vector<FieldRef> fields = list_fields(config);
  if (!arguments.config_file.empty()) load_yaml(fields, arguments.config_file);
  for (const std::string& setting : arguments.settings) set_value(fields, setting, "--set");
  if (!arguments.dynamics.empty()) {
    set_value(fields, "dynamics.mode=" + arguments.dynamics, "--dynamics");
  }
  config.check();
  return config;
}

std::optional<CameraModel> chosen_camera(const std::string& name) {
  if (name.empty()) return std::nullopt;
  return camera_by_name(name);
}

TumSequence open_sequence(const RunArguments& arguments) {
  try {
    return TumSequence::open(arguments.sequence, {.camera = chosen_camera(arguments.camera)});
  } catch (const UnknownCamera& error) {
    throw Error("{} (--camera NAME or FILE names it)", error.what());
  }
}

/// What finds people and things, and how that is said.
struct ChosenSegmenter {
  std::unique_ptr<Segmenter> segmenter;  // null: nothing does
  std::string line;
  std::string warning = {};
};

ChosenSegmenter default_segmenter(cv::Size image, const SegmenterOptions& options) {
  try {
    return {make_segmenter("auto", image, options), "auto, the networks of make models"};
  } catch (const Error& error) {
    return {
        nullptr,
        "none: no networks here (make models gets them); people who stand still get into the map",
        fmt::format("nothing looks for people and things: {}", error.what())};
  }
}

ChosenSegmenter choose_segmenter(const RunArguments& arguments,
                                 const TumSequence& sequence,
                                 const CameraModel& camera,
                                 const DynamicsMode& mode) {
  const cv::Size image(camera.width_px, camera.height_px);
  const SegmenterOptions options{.threads = arguments.live ? 1 : 2,
                                 .image_names = image_names(sequence.entries())};
  const std::string& asked = arguments.segmenter;
  if (asked == "none" || (asked.empty() && !mode.judges)) return {nullptr, "none, as asked for"};
  if (asked.empty()) return default_segmenter(image, options);
  return {
      option_value("--segmenter",
                   asked,
                   [&](const std::string& text) { return make_segmenter(text, image, options); }),
      asked};
}

// The results' folder; that of the option, where it cannot be used.
void prepare_out(const RunArguments& arguments) {
  (void)option_value("--out", arguments.out, [](const std::string& folder) {
    prepare_run_folder(folder);
    return true;
  });
}

std::optional<Trajectory> read_groundtruth(const RunArguments& arguments,
                                           const TumSequence& sequence) {
  if (!arguments.groundtruth.empty()) return read_trajectory(arguments.groundtruth);
  const std::optional<std::filesystem::path> own = sequence.groundtruth_file();
  return own ? std::optional(read_trajectory(*own)) : std::nullopt;
}

void evaluate(RunReport& report) {
  if (!report.groundtruth) return;
  report.ate = absolute_trajectory_error(*report.groundtruth, report.estimate);
  report.rpe = relative_pose_error(*report.groundtruth, report.estimate);
  if (!report.ate) {
    report.warnings.push_back("no ground-truth pose is within 0.02 s of three tracked frames");
  }
}

void choose_map(SequenceRun& run, const RunArguments& arguments) {
  if (arguments.poses == "truth") {
    if (run.map_at_true_poses) {
      run.result.map = std::move(*run.map_at_true_poses);
      run.report.map_at_true_poses = true;
    } else {
      run.report.warnings.push_back(
          "--poses truth: fewer than three tracked frames have ground truth; the map has the "
          "estimated poses");
    }
  }
  run.report.map = &run.result.map;
}

void evaluate_maps(SequenceRun& run, const SequenceTruth& truth) {
  RunReport& report = run.report;
  try {
    report.map_quality = run_map_quality(*report.map, report.estimate, truth);
    if (report.map_at_true_poses) {
      report.map_quality_true_poses = report.map_quality;
    } else if (run.map_at_true_poses) {
      report.map_quality_true_poses =
          run_map_quality(*run.map_at_true_poses, report.estimate, truth);
    }
  } catch (const Error& error) {  // a map that is nowhere must not cost the results of a long run
    report.warnings.push_back(fmt::format("no figures of the map: {}", error.what()));
  }
}

// The map of a run that only localises is the one that it was given.
void save_session(Session& session, const RunArguments& arguments, const std::string& settings) {
  if (arguments.localize_only) return;
  session.config_yaml = settings;
  write_session(std::filesystem::path(arguments.out) / "map.stillmap", session);
}

FrameSelection selected_frames(const RunArguments& arguments) {
  FrameSelection selection;
  if (!arguments.frames.empty()) {
    selection = option_value("--frames", arguments.frames, parse_frames);
  }
  selection.stride = arguments.stride;
  return selection;
}

std::optional<LiveOptions> live_options(const RunArguments& arguments) {
  if (!arguments.live) return std::nullopt;
  LiveOptions live;
  live.speed = arguments.speed;
  if (!arguments.replay.empty()) {
    live.record = read_live_record(arguments.replay);
    live.record_name = arguments.replay;
  }
  return live;
}

int run(const RunArguments& arguments) {
  SystemConfig config = make_config(arguments);
  if (arguments.localize_only && arguments.load.empty()) {
    throw Error(
        "--localize-only needs a map to find the camera in: name a map.stillmap with --load");
  }
  const TumSequence sequence = open_sequence(arguments);
  std::optional<Trajectory> groundtruth = read_groundtruth(arguments, sequence);
  if (arguments.poses == "truth" && !groundtruth) {
    throw Error("--poses truth: {} has no groundtruth.txt; name one with --groundtruth",
                sequence.folder().string());
  }
  const std::optional<SequenceTruth> truth = read_sequence_truth(arguments.sequence);
  TumFolder frames(sequence, selected_frames(arguments));
  const ChosenSegmenter chosen =
      choose_segmenter(arguments, sequence, frames.camera(), dynamics_mode(config.dynamics.mode));
  RunOptions options;
  if (!arguments.load.empty()) options.start = read_session(arguments.load);
  options.localize_only = arguments.localize_only;
  prepare_out(arguments);
  options.segmenter = chosen.segmenter.get();
  options.threads = arguments.threads;
  options.live = live_options(arguments);
  SteadyClock clock;
  if (options.live) options.live->clock = &clock;
  if (truth || arguments.poses == "truth") options.groundtruth = groundtruth;
  RunProgress progress(frames.size(), chosen.line);
  std::vector<Observer*> observers = {&progress};
  std::optional<ObjectFolder> objects;
  if (!arguments.objects_out.empty()) {
    observers.push_back(&objects.emplace(
        arguments.objects_out, cv::Size(frames.camera().width_px, frames.camera().height_px)));
  }
  std::optional<InpaintedFolder> inpainted;
  if (!arguments.inpainted.empty()) {
    observers.push_back(&inpainted.emplace(arguments.inpainted, frames.camera()));
  }
  SequenceRun run = run_sequence(frames, config, std::move(options), observers);

  RunReport& report = run.report;
  if (!chosen.warning.empty()) report.warnings.push_back(chosen.warning);
  report.version = kVersion;
  report.sequence = sequence.name();
  report.config_yaml = dump_yaml(list_fields(config));
  report.groundtruth = std::move(groundtruth);
  evaluate(report);
  choose_map(run, arguments);
  if (truth) evaluate_maps(run, *truth);
  const std::optional<std::string> live_lines =
      arguments.live ? std::optional(live_jsonl(run.live_record)) : std::nullopt;
  write_run_folder(arguments.out, run.result, report, {run.objects_jsonl, live_lines});
  save_session(run.session, arguments, report.config_yaml);
  print_output(run_summary(report, chosen.line, arguments.out));
  return run.result.lost_at_end ? kLostForGood : 0;
}

void add_inputs(CLI::App& command, RunArguments& arguments) {
  command.add_option("SEQUENCE", arguments.sequence, "folder in the TUM RGB-D layout")->required();
  command.add_option(
      "--camera",
      arguments.camera,
      "tum_fr1, tum_fr2, tum_fr3, bonn or a camera.yaml; instead of the sequence's own");
  command.add_option("--frames", arguments.frames, "A:B, only frames A to B - 1, counted from 0");
  command.add_option("--stride", arguments.stride, "take every N-th frame")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000}));
  command.add_option("--groundtruth",
                     arguments.groundtruth,
                     "trajectory to compare with; instead of the sequence's own");
}

void add_settings(CLI::App& command, RunArguments& arguments) {
  command.add_option("--out", arguments.out, "folder for the results")->required();
  command.add_option("--config", arguments.config_file, "settings, see `stillmap config`");
  command.add_option("--set", arguments.settings, "one setting, key=value; repeatable")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_option(
      "--segmenter",
      arguments.segmenter,
      "what finds people and things: none, detections:DIR, masks:DIR (plain masks of "
      "people), onnx:MODEL.onnx, or auto (the networks of `make models`); auto where these are "
      "there, else none");
  command.add_option(
      "--write-objects",
      arguments.objects_out,
      "folder for the objects of every frame as they were used, with masks: a folder "
      "of detections");
  command.add_option("--inpainted",
                     arguments.inpainted,
                     "folder for the frames without what moves in them, which shows what earlier "
                     "key frames saw behind it: a sequence");
  command.add_option("--dynamics",
                     arguments.dynamics,
                     fmt::format("what is done about what moves: {}; as dynamics.mode",
                                 joined(dynamics_mode_names(), ", ")));
  command.add_option("--load",
                     arguments.load,
                     "a map.stillmap to go on from, once the camera sees a place that it has");
  command.add_flag("--localize-only",
                   arguments.localize_only,
                   "with --load: track against that map and leave it as it is");
  CLI::Option* live = command.add_flag(
      "--live",
      arguments.live,
      "as with a camera: frames come at their times and are dropped when nobody has time for them; "
      "the network looks at some of them beside the rest");
  command.add_option("--speed", arguments.speed, "with --live: how much faster time goes")
      ->needs(live)
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  command
      .add_option("--replay",
                  arguments.replay,
                  "with --live: the live.jsonl of an earlier run, to make it again bit by bit")
      ->needs(live);
  command
      .add_option("--poses",
                  arguments.poses,
                  "where the map's key frames are: as estimated, or where the ground truth (truth) "
                  "has them; the trajectory is the estimate in any case")
      ->check(CLI::IsMember({"estimated", "truth"}))
      ->capture_default_str();
  command.add_option("--threads", arguments.threads, "1 or more; the result is the same")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
}

}  // namespace

void add_run_command(CLI::App& app, CommandResult& result) {
  CLI::App* command = app.add_subcommand("run", "Trajectory, map and report of a sequence");
  const auto arguments = std::make_shared<RunArguments>();
  add_inputs(*command, *arguments);
  add_settings(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  stillmap run rgbd_dataset_freiburg1_xyz --out result\n"
      "  stillmap run office --out result --frames 0:300 --set cloud.voxel_size_m=0.02\n"
      "  stillmap run office --out more --load result/map.stillmap --localize-only\n"
      "  stillmap run office --out result --segmenter detections:office/detections\n"
      "  stillmap run office --out live --live\n"
      "  stillmap run office --out again --live --replay live/live.jsonl\n"
      "Exit code 3 says that tracking was lost for good: the results end before the sequence "
      "does.");
  command->callback([arguments, &result] { result.exit_code = run(*arguments); });
}

}  // namespace stillmap
