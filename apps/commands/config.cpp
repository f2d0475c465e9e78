// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "apps/commands.hpp"
#include "stillmap/config/config_io.hpp"
#include "stillmap/session/system_config.hpp"

namespace stillmap {
namespace {

std::string describe_common(const std::vector<FieldRef>& fields) {
  const std::vector<FieldRef> common = common_fields(fields);
  return describe(common) +
         fmt::format("{} more settings: stillmap config --all\n", fields.size() - common.size());
}

}  // namespace

void add_config_command(CLI::App& app, CommandResult& /*result*/) {
  CLI::App* command =
      app.add_subcommand("config", "Print the settings, or check a file of settings");
  const auto file = std::make_shared<std::string>();
  const auto all = std::make_shared<bool>(false);
  command->add_option("FILE", *file, "YAML file to check");
  command->add_flag("--all", *all, "print every setting, not only those that people change");
  command->callback([file, all] {
    SystemConfig config;
    const std::vector<FieldRef> fields = list_fields(config);
    if (!file->empty()) {
      load_yaml(fields, *file);
      print_output(fmt::format("{}: a correct configuration\n", *file));
    } else if (*all) {
      print_output(describe(fields));
    } else {
      print_output(describe_common(fields));
    }
  });
}

}  // namespace stillmap
