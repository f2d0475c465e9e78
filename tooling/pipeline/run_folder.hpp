// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "stillmap/io/folder_replacement.hpp"
#include "stillmap/session/session.hpp"
#include "stillmap/system/system.hpp"
#include "tooling/report/run_report.hpp"

namespace stillmap {

/// The names of all files that a run may leave in its folder.
[[nodiscard]] std::span<const std::string_view> run_file_names();

/// What a run has of every frame, if it has it.
struct FrameLogs {
  std::optional<std::string> objects_jsonl;
  std::optional<std::string> live_jsonl;
  std::optional<std::string> movers_ply;
};

/// The folder with the results of a run. They replace those of an earlier run as a whole.
class RunFolder {
 public:
  /// Creates the folder if it is missing and checks that files can be written there, before a long
  /// run. Nobody else can write results there until the destructor. Throws Error naming the folder.
  explicit RunFolder(const std::filesystem::path& folder);

  /// Writes trajectory.txt, keyframes.txt, config.yaml, camera.yaml, map.ply, report.json,
  /// report.html and, where the run has them, objects.jsonl, live.jsonl, movers.ply and
  /// map.stillmap: all of them or none. A file of an earlier run that this one does not have goes;
  /// files of others stay. camera.yaml is the camera as used, with the estimated readout time.
  /// Throws Error naming the file that could not be written. To be called once.
  void write(const RunResult& result,
             const RunReport& report,
             const FrameLogs& logs,
             const Session* session);

 private:
  std::filesystem::path folder_;
  FolderReplacement files_;
};

}  // namespace stillmap
