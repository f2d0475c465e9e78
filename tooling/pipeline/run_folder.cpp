// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/run_folder.hpp"

#include <algorithm>
#include <array>

#include "stillmap/io/ply.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/session/session_io.hpp"
#include "tooling/report/report_html.hpp"
#include "tooling/report/report_json.hpp"

namespace stillmap {
namespace {

constexpr std::array<std::string_view, 11> kFiles = {"trajectory.txt",
                                                     "keyframes.txt",
                                                     "config.yaml",
                                                     "camera.yaml",
                                                     "objects.jsonl",
                                                     "live.jsonl",
                                                     "map.ply",
                                                     "movers.ply",
                                                     "report.json",
                                                     "report.html",
                                                     "map.stillmap"};

bool is_run_file(const std::filesystem::path& name) {
  return std::ranges::find(kFiles, name.string()) != kFiles.end();
}

}  // namespace

std::span<const std::string_view> run_file_names() {
  return kFiles;
}

RunFolder::RunFolder(const std::filesystem::path& folder)
    : folder_(folder), files_(folder, is_run_file) {}

void RunFolder::write(const RunResult& result,
                      const RunReport& report,
                      const FrameLogs& logs,
                      const Session* session) {
  files_.write("trajectory.txt", format_trajectory(result.trajectory));
  files_.write("keyframes.txt", format_trajectory(result.keyframes));
  files_.write("config.yaml", report.config_yaml);
  files_.write("camera.yaml", format_camera_yaml(report.camera));
  if (logs.objects_jsonl) files_.write("objects.jsonl", *logs.objects_jsonl);
  if (logs.movers_ply) files_.write("movers.ply", *logs.movers_ply);
  if (logs.live_jsonl) files_.write("live.jsonl", *logs.live_jsonl);
  files_.write("map.ply", encode_ply(result.map));
  files_.write("report.json", report_json(report));
  files_.write("report.html", report_html(report));
  if (session != nullptr) {
    const std::string place = "cannot write " + (folder_ / "map.stillmap").string();
    files_.write("map.stillmap", [&](const FolderReplacement::Sink& sink) {
      write_session(sink, *session, place);
    });
  }
  files_.take_place();
}

}  // namespace stillmap
