// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "stillmap/system/system.hpp"
#include "tooling/report/run_report.hpp"

namespace stillmap {

/// Creates the folder if it is missing and checks that files can be written there, before a long
/// run. Throws Error naming the folder.
void prepare_run_folder(const std::filesystem::path& folder);

/// Logs with a line per frame, if the run has them.
struct FrameLines {
  std::optional<std::string> objects_jsonl;
  std::optional<std::string> live_jsonl;
};

/// Writes trajectory.txt, keyframes.txt, config.yaml, camera.yaml, objects.jsonl, live.jsonl,
/// map.ply, report.json and report.html, each whole or not at all, the trajectory first. The file
/// of a log that this run does not have is removed, if an earlier run left it. camera.yaml is the
/// camera as used, with the estimated readout time. Throws Error naming the file that could not be
/// written.
void write_run_folder(const std::filesystem::path& folder,
                      const RunResult& result,
                      const RunReport& report,
                      const FrameLines& lines);

}  // namespace stillmap
