// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <CLI/CLI.hpp>

namespace stillmap {

/// Parses the arguments (without the program's name) and runs their command. Help and version go to
/// standard output. Throws Error, with a pointer to the right --help, for wrong usage. Exceptions
/// of the command pass through.
void run_command_line(CLI::App& app, std::span<const std::string> arguments);

}  // namespace stillmap
