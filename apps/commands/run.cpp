// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "apps/command_inputs.hpp"
#include "apps/commands.hpp"
#include "apps/image_names.hpp"
#include "apps/interruption.hpp"
#include "apps/option_value.hpp"
#include "apps/run_arguments.hpp"
#include "apps/run_evaluation.hpp"
#include "apps/run_input.hpp"
#include "apps/run_progress.hpp"
#include "apps/run_summary.hpp"
#include "apps/sequence_option.hpp"
#include "apps/steady_clock.hpp"
#include "apps/version.hpp"
#include "apps/viewer_option.hpp"
#include "stillmap/config/config_io.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/session/session_io.hpp"
#include "tooling/pipeline/inpainted_folder.hpp"
#include "tooling/pipeline/moving_points.hpp"
#include "tooling/pipeline/object_folder.hpp"
#include "tooling/pipeline/run_folder.hpp"
#include "tooling/pipeline/run_sequence.hpp"

namespace stillmap {
namespace {

constexpr int kLostForGood = 3;
constexpr int kInterrupted = 4;
constexpr double kMaxDepthM = 100;  // of settings

// `noise`: of stereo pairs, whose depth is not as exact as that of a depth camera.
SystemConfig make_config(const RunArguments& arguments, const std::optional<DepthNoise>& noise) {
  SystemConfig config;
  if (noise) {
    config.measurement.inverse_depth_sigma = noise->inverse_depth_sigma;
    config.measurement.max_depth_m = std::min(noise->max_depth_m, kMaxDepthM);
    config.mapping.creation.max_depth_m = std::min(noise->max_depth_m, kMaxDepthM);
  }
  const std::vector<FieldRef> fields = list_fields(config);
  if (!arguments.config_file.empty()) load_yaml(fields, arguments.config_file);
  for (const std::string& setting : arguments.settings) set_value(fields, setting, "--set");
  if (!arguments.dynamics.empty()) {
    set_value(fields, "dynamics.mode=" + arguments.dynamics, "--dynamics");
  }
  config.check();
  return config;
}

bool is_live(const RunArguments& arguments) {
  return arguments.live || !arguments.device.empty();
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
                                 RunInput& input,
                                 const DynamicsMode& mode) {
  const CameraModel& camera = input.frames().camera();
  const cv::Size image(camera.width_px, camera.height_px);
  const SegmenterOptions options{.threads = is_live(arguments) ? 1 : 2,
                                 .image_names = image_names(input.entries())};
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
std::unique_ptr<RunFolder> prepare_out(const RunArguments& arguments) {
  return option_value("--out", arguments.out, [](const std::string& folder) {
    return std::make_unique<RunFolder>(folder);
  });
}

// No file that the run reads may be one that it writes.
void check_outputs(const RunArguments& arguments, const RunInput& input) {
  InputFiles inputs;
  if (!input.is_device()) add_sequence(inputs, arguments.sequence.path, input.entries());
  add_segmenter(inputs, arguments.segmenter);
  add_camera(inputs, arguments.sequence.camera);
  for (const std::string& file :
       {arguments.config_file, arguments.groundtruth, arguments.load, arguments.replay}) {
    inputs.add(file);
  }
  const std::filesystem::path out = arguments.out, objects = arguments.objects_out;
  for (const std::string_view name : run_file_names()) inputs.check_output("--out", out / name);
  if (!objects.empty()) {
    inputs.check_output("--write-objects", objects / "detections.jsonl");
    inputs.check_output("--write-objects", objects / "masks");
    std::error_code ignored;
    if (std::filesystem::weakly_canonical(objects / "masks", ignored) ==
        std::filesystem::weakly_canonical(out / "masks", ignored)) {
      throw Error("--write-objects {}: is the folder of --out; name another, such as {}",
                  arguments.objects_out,
                  (out / "objects").string());
    }
  }
  if (arguments.localize_only && path_exists(out / "map.stillmap")) {
    throw Error(
        "--out {}: holds a map.stillmap, which a run with --localize-only has not; name another "
        "folder",
        arguments.out);
  }
}

std::optional<LiveOptions> live_options(const RunArguments& arguments) {
  if (!is_live(arguments)) return std::nullopt;
  LiveOptions live;
  live.arriving = !arguments.device.empty();
  live.speed = arguments.speed;
  if (!arguments.replay.empty()) {
    live.record = read_live_record(arguments.replay);
    live.record_name = arguments.replay;
  }
  return live;
}

/// What a run keeps of every frame: folders with a file or more for each, and the movers.
class KeptFrames {
 public:
  KeptFrames(const RunArguments& arguments, const CameraModel& camera) {
    const cv::Size image(camera.width_px, camera.height_px);
    if (!arguments.objects_out.empty()) objects_.emplace(arguments.objects_out, image);
    if (!arguments.inpainted.empty()) inpainted_.emplace(arguments.inpainted, camera);
    if (arguments.keep_movers) movers_.emplace(camera);
  }

  [[nodiscard]] std::vector<Observer*> observers_with(std::vector<Observer*> observers) {
    if (objects_) observers.push_back(&*objects_);
    if (inpainted_) observers.push_back(&*inpainted_);
    if (movers_) observers.push_back(&*movers_);
    return observers;
  }

  [[nodiscard]] std::optional<std::string> movers_ply(const Trajectory& final_poses) const {
    return movers_ ? std::optional(movers_->ply(final_poses)) : std::nullopt;
  }
  [[nodiscard]] std::vector<StampedGhosts> movers_for_report() const {
    constexpr std::size_t kMostPoints = 100'000;  // 1.3 MB of the report
    return movers_ ? movers_->ghosts(kMostPoints) : std::vector<StampedGhosts>();
  }

 private:
  std::optional<ObjectFolder> objects_;
  std::optional<InpaintedFolder> inpainted_;
  std::optional<MovingPoints> movers_;
};

// The run; what was read is kept, if that is asked for, even where the run fails.
SequenceRun run_and_keep(RunInput& input,
                         const SystemConfig& config,
                         RunOptions options,
                         std::span<Observer* const> observers) {
  try {
    return run_sequence(input.frames(), config, std::move(options), observers);
  } catch (const Error&) {
    print_output(input.finish_recording());
    throw;
  }
}

// What the run itself does not know.
void complete(RunReport& report,
              const RunInput& input,
              std::string config_yaml,
              const KeptFrames& kept) {
  report.version = kVersion;
  report.sequence = input.name();
  report.config_yaml = std::move(config_yaml);
  report.movers = kept.movers_for_report();
  report.groundtruth = input.true_poses();
  evaluate(report);
}

int run(const RunArguments& arguments) {
  if (arguments.localize_only && arguments.load.empty()) {
    throw Error(
        "--localize-only needs a map to find the camera in: name a map.stillmap with --load");
  }
  SteadyClock clock;
  RunInput input(arguments, clock);
  SystemConfig config = make_config(arguments, input.depth_noise());
  note_interruption();
  const ChosenSegmenter chosen =
      choose_segmenter(arguments, input, dynamics_mode(config.dynamics.mode));
  RunOptions options;
  if (!arguments.load.empty()) options.start = read_session(arguments.load);
  options.localize_only = arguments.localize_only;
  check_outputs(arguments, input);
  const std::unique_ptr<RunFolder> out = prepare_out(arguments);
  options.segmenter = chosen.segmenter.get();
  options.threads = arguments.threads;
  options.live = live_options(arguments);
  if (options.live) options.live->clock = &clock;
  if (input.truth() || arguments.poses == "truth") options.groundtruth = input.true_poses();
  RunProgress progress(input.frames().size(), chosen.line);
  std::vector<std::string> early = input.warnings();
  for (const std::string& warning : early) progress.on_warning(warning);
  if (!chosen.warning.empty()) early.push_back(chosen.warning);
  KeptFrames kept(arguments, input.frames().camera());
  RunViewer viewer(arguments.viewer,
                   {input.name(), input.frames().size(), input.frames().camera()});
  SequenceRun run = run_and_keep(
      input, config, std::move(options), kept.observers_with({&progress, viewer.observer()}));

  RunReport& report = run.report;
  report.warnings.insert(report.warnings.begin(), early.begin(), early.end());
  const std::string interruption = input.interruption();
  if (!interruption.empty()) {
    report.warnings.push_back(interruption);
    progress.on_warning(interruption);
  }
  complete(report, input, dump_yaml(list_fields(config)), kept);
  choose_map(run, arguments.poses == "truth");
  if (input.truth()) evaluate_maps(run, *input.truth());
  const std::optional<std::string> live_lines =
      is_live(arguments) ? std::optional(live_jsonl(run.live_record)) : std::nullopt;
  run.session.config_yaml = report.config_yaml;
  // The map of a run that only localises is the one that it was given.
  const Session* const session = arguments.localize_only ? nullptr : &run.session;
  const std::string recording = input.finish_recording();
  out->write(run.result,
             report,
             {run.objects_jsonl, live_lines, kept.movers_ply(run.result.trajectory)},
             session);
  print_output(run_summary(report, input.line(), chosen.line, arguments.out) + recording);
  if (!interruption.empty()) return kInterrupted;
  viewer.stay();
  return run.result.lost_at_end ? kLostForGood : 0;
}

void add_inputs(CLI::App& command, RunArguments& arguments) {
  CLI::Option* const sequence = add_sequence_options(command, arguments.sequence);
  sequence->required(false);
  command
      .add_option(
          "--device",
          arguments.device,
          "a depth camera in place of SEQUENCE: openni2:0, the first that OpenNI2 finds, or "
          "openni2:URI; v4l2:COLOR,DEPTH, two video nodes; stream:ws://HOST:PORT, a robot's "
          "rosbridge; the run is live and goes on until Ctrl-C")
      ->excludes(sequence);
  command.add_option("--save-recording",
                     arguments.save_recording,
                     "new folder for the frames of a live run, as a sequence: all that came, also "
                     "those that were dropped");
  command.add_option(
      "--camera",
      arguments.sequence.camera,
      "tum_fr1, tum_fr2, tum_fr3, bonn or a camera file (also of ORB-SLAM, stella_vslam, ROS, "
      "Open3D, RealSense); instead of the sequence's own");
  command
      .add_option("--depth-factor",
                  arguments.depth_factor,
                  "units of a depth image per metre, such as 1000; instead of the camera's")
      ->check(CLI::PositiveNumber);
  command.add_option("--frames", arguments.frames, "A:B, only frames A to B - 1, counted from 0");
  command.add_option("--stride", arguments.stride, "take every N-th frame")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000}));
  command.add_option(
      "--groundtruth",
      arguments.groundtruth,
      "trajectory to compare with; instead of the sequence's own; none: with nothing");
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
  command.add_flag("--keep-movers",
                   arguments.keep_movers,
                   "write movers.ply: what moved, with stamp and track; the report plays it");
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
  add_view_options(command, arguments.viewer);
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
  for (const char* of_recordings : {"--format",
                                    "--rate",
                                    "--stamps",
                                    "--depth-factor",
                                    "--frames",
                                    "--stride",
                                    "--groundtruth",
                                    "--speed",
                                    "--replay",
                                    "--poses"}) {
    command->get_option("--device")->excludes(command->get_option(of_recordings));
  }
  command->footer(
      "Examples:\n"
      "  stillmap run rgbd_dataset_freiburg1_xyz --out result\n"
      "  stillmap run office --out result --frames 0:300 --set cloud.voxel_size_m=0.02\n"
      "  stillmap run office --out more --load result/map.stillmap --localize-only\n"
      "  stillmap run office --out result --segmenter detections:office/detections\n"
      "  stillmap run office --out live --live\n"
      "  stillmap run office --out again --live --replay live/live.jsonl\n"
      "  stillmap run --device openni2:0 --out live --save-recording kept\n"
      "  stillmap run --device v4l2:/dev/video4,/dev/video2 --camera d435.yaml --out live\n"
      "  stillmap run --device stream:ws://robot:9090 --out live\n"
      "Exit code 3 says that tracking was lost for good, 4 that Ctrl-C or SIGTERM ended the run: "
      "the\nresults are whole, but end before the sequence does. A second Ctrl-C ends at once.\n"
      "Of a run on a device Ctrl-C is the usual end.");
  command->callback([arguments, &result] { result.exit_code = run(*arguments); });
}

}  // namespace stillmap
