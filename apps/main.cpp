// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <opencv2/core/base.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/core/version.hpp>

#include "apps/command_line.hpp"
#include "apps/commands.hpp"
#include "apps/version.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {

void print_output(std::string_view text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) throw Error("standard output cannot be written");
}

namespace {

constexpr int kInternalError = 1;
constexpr int kBadInput = 2;

constexpr const char* kExamples =
    "Examples:\n"
    "  stillmap synth office --scene walking_xyz   render a sequence with people and its truth\n"
    "  stillmap run office --out result            trajectory, map and report of a sequence\n"
    "  stillmap run office --out result --set tracking.features=2000\n"
    "  stillmap evaluate trajectory office/groundtruth.txt result/trajectory.txt\n"
    "  stillmap show result                        its map, camera and objects in a browser\n"
    "  stillmap export result --octomap map.bt     its map for other programs\n"
    "  stillmap view result/map.ply --out map.png  the map from the front, the left and above\n"
    "  stillmap config                             the common settings, their defaults and "
    "meanings\n";

std::string version_text() {
  const std::string commit = kCommit.empty() ? "" : fmt::format(" (commit {})", kCommit);
  return fmt::format("stillmap {}{}\nOpenCV {}, {}\n{}",
                     kVersion,
                     commit,
                     CV_VERSION,
                     kLibraryVersions,
                     kCompiler);
}

using AddCommand = void (*)(CLI::App&, CommandResult&);

// The commands, in the order of --help.
const std::vector<AddCommand> kCommands = {add_run_command,
                                           add_segment_command,
#if STILLMAP_WITH_SIMULATION
                                           add_synth_command,
#endif
                                           add_evaluate_command,
                                           add_export_command,
                                           add_merge_command,
                                           add_show_command,
                                           add_view_command,
                                           add_models_command,
                                           add_config_command};

int run(const std::vector<std::string>& arguments) {
  CommandResult result;
  CLI::App app("RGB-D SLAM: the camera's trajectory and a clean 3-D map of the static world",
               "stillmap");
  app.set_version_flag("--version", version_text, "Print the versions of program and libraries");
  app.require_subcommand(1);
  for (const AddCommand add_command : kCommands) add_command(app, result);
  app.footer(kExamples);  // last, because subcommands would inherit it
  run_command_line(app, arguments);
  return result.exit_code;
}

// Nothing here allocates.
int out_of_memory() {
  std::fputs(
      "stillmap: out of memory: close other programs, or take a part of the sequence (--frames)\n",
      stderr);
  return kBadInput;
}

}  // namespace
}  // namespace stillmap

int main(int argc, char** argv) {
  // This program has its own threads. OpenCV's would compete with them.
  cv::setNumThreads(1);
  try {
    return stillmap::run(std::vector<std::string>(argv + 1, argv + argc));
  } catch (const stillmap::Error& error) {
    fmt::print(stderr, "stillmap: {}\n", error.what());
    return stillmap::kBadInput;
  } catch (const std::bad_alloc&) {
    return stillmap::out_of_memory();
  } catch (const cv::Exception& error) {
    if (error.code == cv::Error::StsNoMem) return stillmap::out_of_memory();
    fmt::print(stderr, "stillmap: internal error: {}\n", error.err);
  } catch (const std::system_error& error) {  // no more threads, for example
    fmt::print(stderr, "stillmap: the system refuses what the program needs: {}\n", error.what());
    return stillmap::kBadInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "stillmap: internal error: {}\n", error.what());
  } catch (...) {
    std::fputs("stillmap: internal error of unknown kind\n", stderr);
  }
  return stillmap::kInternalError;
}
