// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <fmt/core.h>

#include "apps/commands.hpp"
#include "stillmap/config/config_io.hpp"
#include "stillmap/session/system_config.hpp"

namespace stillmap {

void add_config_command(CLI::App& app, CommandResult& /*result*/) {
  CLI::App* command =
      app.add_subcommand("config", "Print every configuration key, or check a configuration file");
  const auto file = std::make_shared<std::string>();
  command->add_option("FILE", *file, "YAML file to check");
  command->callback([file] {
    SystemConfig config;
    if (file->empty()) {
      print_output(describe(list_fields(config)));
      return;
    }
    load_yaml(list_fields(config), *file);
    print_output(fmt::format("{}: a correct configuration\n", *file));
  });
}

}  // namespace stillmap
