// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "apps/commands.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

// The script fetch_models with what it needs: beside an installed program, or in the clone in whose
// build/NAME/bin the program is.
fs::path script() {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  for (const char* place :
       {"../share/stillmap/tools/fetch_models", "../../../tools/fetch_models"}) {
    const fs::path file = (folder / place).lexically_normal();
    if (fs::exists(file)) return file;
  }
  throw Error("models: no share/stillmap/tools/fetch_models beside {}; install stillmap whole",
              folder.string());
}

// The script takes over this process: its messages and exit code are those of the command.
void become_script() {
  std::string file = script().string();
  const std::array<char*, 2> arguments = {file.data(), nullptr};
  execv(file.c_str(), arguments.data());
  throw Error("{}: cannot be run ({})", file, std::generic_category().message(errno));
}

}  // namespace

void add_models_command(CLI::App& app, CommandResult& /*result*/) {
  CLI::App* command =
      app.add_subcommand("models", "Get the networks of --segmenter auto: 300 MB, once");
  command->footer(
      "By npm. 45 MB are kept, in $STILLMAP_MODELS, else in ~/.local/share/stillmap/models; "
      "nothing is\n"
      "fetched where they are there.");
  command->callback([] { become_script(); });
}

}  // namespace stillmap
