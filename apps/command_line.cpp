// SPDX-License-Identifier: Apache-2.0
#include "apps/command_line.hpp"

#include <algorithm>
#include <sstream>
#include <vector>

#include <fmt/core.h>

#include "apps/commands.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/core/nearest_name.hpp"

namespace stillmap {
namespace {

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

// The command as far as it was recognised, such as "stillmap evaluate map".
std::string command_path(const CLI::App& app) {
  std::string path = app.get_name();
  for (const CLI::App* command = &app; !command->get_subcommands().empty();) {
    command = command->get_subcommands().front();
    path += ' ' + command->get_name();
  }
  return path;
}

// CLI11 takes a misspelt command for a surplus argument. This message names it, with the nearest
// command.
void check_command_names(const CLI::App& app, std::span<const std::string> arguments) {
  const CLI::App* command = &app;
  std::string path = app.get_name();
  for (const std::string& argument : arguments) {
    const std::vector<std::string> names = subcommand_names(*command);
    if (names.empty() || argument.starts_with('-')) return;
    if (std::ranges::find(names, argument) == names.end()) {
      throw Error(
          "unknown command '{}': {} (see {} --help)", argument, name_hint(argument, names), path);
    }
    command = command->get_subcommand(argument);
    path += ' ' + argument;
  }
}

std::string one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

}  // namespace

void run_command_line(CLI::App& app, std::span<const std::string> arguments) {
  check_command_names(app, arguments);
  try {
    // CLI11 takes arguments from the back.
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Success& asked_for_text) {
    std::ostringstream text;
    app.exit(asked_for_text, text, text);
    print_output(text.str());
  } catch (const CLI::ParseError& error) {
    throw Error("{} (see {} --help)", one_line(error.what()), command_path(app));
  }
}

}  // namespace stillmap
