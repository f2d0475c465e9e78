// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/export_source.hpp"

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/ply.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/session/session_cloud.hpp"
#include "stillmap/session/session_io.hpp"
#include "stillmap/session/session_map.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

CameraModel folder_camera(const fs::path& folder) {
  const fs::path file = folder / "camera.yaml";
  if (!path_exists(file)) {
    throw Error("{}: missing, as in folders of older versions; run again, or give --camera",
                file.string());
  }
  return read_camera_yaml(file);
}

void add_keyframes(FinishedRun& run, const Trajectory& keyframes) {
  for (const StampedPose& keyframe : keyframes) {
    run.T_world_keyframe.push_back(keyframe.T_world_camera);
  }
}

FinishedRun read_folder(const fs::path& folder) {
  if (!path_exists(folder / "map.ply") || !path_exists(folder / "keyframes.txt")) {
    throw Error(
        "{}: not the folder of a finished run: expected map.ply and keyframes.txt in it, as "
        "`stillmap run --out` writes them; or a saved session",
        folder.string());
  }
  FinishedRun run;
  run.map = read_ply(folder / "map.ply");
  if (run.map.empty()) throw Error("{}: no points", (folder / "map.ply").string());
  add_keyframes(run, read_trajectory(folder / "keyframes.txt"));
  return run;
}

FinishedRun read_saved(const fs::path& file) {
  const Session session = read_session(file);
  const SubmapId submap = main_submap(session);
  if (!submap.valid()) throw Error("{}: no frame in it was tracked", file.string());
  FinishedRun run;
  run.map = session_cloud(session, submap, file.string());
  if (run.map.empty()) throw Error("{}: no points in it", file.string());
  add_keyframes(run, keyframes_in(session, submap));
  run.camera = session.camera;
  return run;
}

}  // namespace

FinishedRun read_finished_run(const fs::path& source, const std::string& camera, bool with_camera) {
  std::error_code ignored;
  const bool is_session = fs::is_regular_file(source, ignored);
  FinishedRun run = is_session ? read_saved(source) : read_folder(source);
  if (!with_camera) return run;
  if (!camera.empty()) {
    run.camera = camera_by_name(camera);
  } else if (!is_session) {
    run.camera = folder_camera(source);
  }
  return run;
}

}  // namespace stillmap
