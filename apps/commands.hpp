// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <CLI/CLI.hpp>

namespace stillmap {

/// The result of a command for the end of the program.
struct CommandResult {
  int exit_code = 0;
};

// Each function adds a subcommand to the program's command line. The callback of the subcommand
// does the work, throws Error for wrong usage or input, and sets exit codes other than 0 in
// `result`, which outlives the callback.
//
// A new command needs apps/commands/NAME.cpp and a line here, in the table of main.cpp and in
// CMakeLists.txt.
void add_synth_command(CLI::App& app, CommandResult& result);
void add_segment_command(CLI::App& app, CommandResult& result);
void add_run_command(CLI::App& app, CommandResult& result);
void add_evaluate_command(CLI::App& app, CommandResult& result);
void add_export_command(CLI::App& app, CommandResult& result);
void add_merge_command(CLI::App& app, CommandResult& result);
void add_show_command(CLI::App& app, CommandResult& result);
void add_view_command(CLI::App& app, CommandResult& result);
void add_models_command(CLI::App& app, CommandResult& result);
void add_config_command(CLI::App& app, CommandResult& result);

/// Writes to standard output. Throws Error on failure (full disk, closed pipe).
void print_output(std::string_view text);

}  // namespace stillmap
