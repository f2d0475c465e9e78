// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <string>

#include <fmt/core.h>

#include "apps/commands.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/input_files.hpp"
#include "stillmap/session/merge_sessions.hpp"
#include "stillmap/session/session_io.hpp"

namespace stillmap {
namespace {

struct MergeArguments {
  std::string first;
  std::string second;
  std::string out;
};

void run_merge(const MergeArguments& arguments) {
  InputFiles inputs;
  inputs.add(arguments.first);
  inputs.add(arguments.second);
  inputs.check_output("--out", arguments.out);
  const Session first = read_session(arguments.first);
  const Session second = read_session(arguments.second);
  const std::optional<MergedSessions> merged = merge_sessions(first, second, arguments.second);
  if (!merged) {
    throw Error(
        "{} and {}: no place of one is recognised in the other; nothing was written. Sessions of "
        "one room need views of the same things from about the same side",
        arguments.first,
        arguments.second);
  }
  write_session(arguments.out, merged->session);
  print_output(fmt::format("merged      {} + {} key frames by {} {}\nwritten     {}\n",
                           first.map.keyframes().size(),
                           second.map.keyframes().size(),
                           merged->loops,
                           merged->loops == 1 ? "loop" : "loops",
                           arguments.out));
}

}  // namespace

void add_merge_command(CLI::App& app, CommandResult& /*result*/) {
  CLI::App* command =
      app.add_subcommand("merge", "Merge two saved sessions of one room by common places");
  const auto arguments = std::make_shared<MergeArguments>();
  command->add_option("A", arguments->first, "a map.stillmap, whose coordinates are kept")
      ->required();
  command->add_option("B", arguments->second, "another map.stillmap of the same camera")
      ->required();
  command->add_option("--out", arguments->out, "file for the merged session")->required();
  command->footer(
      "Examples:\n"
      "  stillmap merge monday/map.stillmap tuesday/map.stillmap --out office.stillmap\n"
      "  stillmap export office.stillmap --ply office.ply");
  command->callback([arguments] { run_merge(*arguments); });
}

}  // namespace stillmap
