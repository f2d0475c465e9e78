// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "stillmap/system/system.hpp"
#include "tooling/report/run_report.hpp"

namespace stillmap {

/// Makes the folder where it is missing and sees that files can be written there, so that a long
/// run does not end in vain. Throws Error naming it.
void prepare_run_folder(const std::filesystem::path& folder);

/// Lines about each frame, where a run has them.
struct FrameLines {
  std::optional<std::string> objects_jsonl;
  std::optional<std::string> live_jsonl;
};

/// Writes trajectory.txt, keyframes.txt, config.yaml, camera.yaml, objects.jsonl, live.jsonl,
/// map.ply, report.json and report.html, each whole or not at all, the trajectory first. Lines that
/// this run does not have are in no file afterwards, not even one of an earlier run. camera.yaml is
/// the camera as used, with the rolling shutter that was learnt. Throws Error naming the file that
/// could not be written.
void write_run_folder(const std::filesystem::path& folder,
                      const RunResult& result,
                      const RunReport& report,
                      const FrameLines& lines);

}  // namespace stillmap
