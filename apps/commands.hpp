// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <CLI/CLI.hpp>

namespace stillmap {

/// What a command leaves for the program's end.
struct CommandResult {
  int exit_code = 0;
};

// Each command adds its subcommand to the program's command line. The subcommand's callback does
// the work, throws Error for bad usage or bad input, and sets an exit code other than 0 itself.
// `result` outlives the callback.
//
// A new command: apps/commands/NAME.cpp, its line here, in main.cpp's table and in CMakeLists.txt.
void add_synth_command(CLI::App& app, CommandResult& result);
void add_segment_command(CLI::App& app, CommandResult& result);
void add_run_command(CLI::App& app, CommandResult& result);
void add_evaluate_command(CLI::App& app, CommandResult& result);
void add_export_command(CLI::App& app, CommandResult& result);
void add_merge_command(CLI::App& app, CommandResult& result);
void add_view_command(CLI::App& app, CommandResult& result);
void add_config_command(CLI::App& app, CommandResult& result);

/// Writes to standard output. Throws Error when that fails (a full disk, a closed pipe).
void print_output(std::string_view text);

}  // namespace stillmap
