// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "apps/commands.hpp"
#include "apps/viewer_option.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/text_file.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/session/session_cloud.hpp"
#include "stillmap/session/session_io.hpp"
#include "stillmap/session/session_map.hpp"
#include "tooling/browser/logged_frames.hpp"
#include "tooling/eval/map_files.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostObjectBytes = std::size_t{1} << 30U;
constexpr std::size_t kMostReportBytes = std::size_t{1} << 26U;

struct ShowArguments {
  std::string source;
  ViewerArguments viewer;
};

struct ShownRun {
  LoggedRun run;  // without the text of its objects
  std::string objects_jsonl;
  std::size_t dropped = 0;
  PointCloud map;
};

ShownRun read_run_folder(const fs::path& folder) {
  if (!path_exists(folder / "map.ply") || !path_exists(folder / "trajectory.txt")) {
    throw Error(
        "{}: not the folder of a finished run: expected map.ply and trajectory.txt in it, as "
        "`stillmap run --out` writes them; or a saved session",
        folder.string());
  }
  ShownRun shown;
  shown.map = read_map(folder / "map.ply");
  LoggedRun& run = shown.run;
  run.trajectory = read_trajectory(folder / "trajectory.txt");
  if (const fs::path file = folder / "keyframes.txt"; path_exists(file)) {
    run.keyframes = read_trajectory(file);
  }
  if (const fs::path file = folder / "camera.yaml"; path_exists(file)) {
    run.camera = read_camera_yaml(file);
  }
  if (const fs::path file = folder / "objects.jsonl"; path_exists(file)) {
    run.objects_name = file.string();
    shown.objects_jsonl = read_text(file, kMostObjectBytes);
  }
  if (const fs::path file = folder / "report.json"; path_exists(file)) {
    shown.dropped = logged_drops(read_text(file, kMostReportBytes));
  }
  return shown;
}

ShownRun read_saved_session(const fs::path& file) {
  const Session session = read_session(file);
  const SubmapId submap = main_submap(session);
  if (!submap.valid()) throw Error("{}: no frame in it was tracked", file.string());
  ShownRun shown;
  shown.map = session_cloud(session, submap, file.string());
  shown.run.trajectory = trajectory_in(session, submap);
  shown.run.keyframes = keyframes_in(session, submap);
  shown.run.camera = session.camera;
  return shown;
}

void show(const ShowArguments& arguments) {
  std::error_code ignored;
  ShownRun shown = fs::is_regular_file(arguments.source, ignored)
                       ? read_saved_session(arguments.source)
                       : read_run_folder(arguments.source);
  shown.run.objects_jsonl = shown.objects_jsonl;
  std::vector<ViewedFrame> frames = logged_frames(shown.run);
  const std::unique_ptr<ViewServer> server =
      serve_view(arguments.viewer, {arguments.source, frames.size(), std::move(shown.run.camera)});
  for (ViewedFrame& frame : frames) server->inbox().put_frame(std::move(frame), std::nullopt);
  if (shown.dropped > 0) server->inbox().put_dropped(shown.dropped);
  server->inbox().put_end(
      {std::move(shown.map), std::move(shown.run.trajectory), std::move(shown.run.keyframes)});
  server->wake();
  for (;;) pause();  // until a signal ends the program
}

}  // namespace

void add_show_command(CLI::App& app, CommandResult&) {
  CLI::App* command = app.add_subcommand("show", "Show a finished run in a browser");
  const auto arguments = std::make_shared<ShowArguments>();
  command
      ->add_option(
          "RESULT", arguments->source, "the folder of a finished run, or a saved map.stillmap")
      ->required();
  add_view_address(*command, arguments->viewer);
  command->footer(
      "Examples:\n"
      "  stillmap show result\n"
      "  stillmap show result/map.stillmap --view-address 127.0.0.1:8080\n"
      "Prints the address of the page and serves it until Ctrl-C.");
  command->callback([arguments] { show(*arguments); });
}

}  // namespace stillmap
