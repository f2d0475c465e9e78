// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/run_folder.hpp"

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/ply.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "tooling/report/report_html.hpp"
#include "tooling/report/report_json.hpp"

namespace stillmap {
namespace {

void write_or_remove(const std::filesystem::path& file, const std::optional<std::string>& lines) {
  if (lines) {
    write_file_atomically(file, *lines);
  } else {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
  }
}

}  // namespace

void prepare_run_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw Error("{}: cannot make this folder ({}); choose another folder",
                folder.string(),
                error ? error.message() : "a file has its name");
  }
  const std::filesystem::path probe = folder / "trajectory.txt.probe";
  write_file_atomically(probe, "");
  std::filesystem::remove(probe, error);
}

void write_run_folder(const std::filesystem::path& folder,
                      const RunResult& result,
                      const RunReport& report,
                      const FrameLines& lines) {
  write_file_atomically(folder / "trajectory.txt", format_trajectory(result.trajectory));
  write_file_atomically(folder / "keyframes.txt", format_trajectory(result.keyframes));
  write_file_atomically(folder / "config.yaml", report.config_yaml);
  write_file_atomically(folder / "camera.yaml", format_camera_yaml(report.camera));
  write_or_remove(folder / "objects.jsonl", lines.objects_jsonl);
  write_or_remove(folder / "live.jsonl", lines.live_jsonl);
  write_file_atomically(folder / "map.ply", encode_ply(result.map));
  write_file_atomically(folder / "report.json", report_json(report));
  write_file_atomically(folder / "report.html", report_html(report));
}

}  // namespace stillmap
