// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/settings.hpp"

#include "stillmap/config/config_io.hpp"
#include "stillmap/session/system_config.hpp"

namespace stillmap {

Settings::Settings() : config_(std::make_unique<SystemConfig>()) {}
Settings::Settings(const SystemConfig& config) : config_(std::make_unique<SystemConfig>(config)) {}
Settings::Settings(const Settings& other) : Settings(*other.config_) {}
Settings& Settings::operator=(const Settings& other) {
  *config_ = *other.config_;
  return *this;
}
Settings::~Settings() = default;

Settings& Settings::set(std::string_view key, std::string_view value) {
  set_value(list_fields(*config_), key, value, "settings");
  return *this;
}

std::string Settings::get(std::string_view key) const {
  return value_text(list_fields(*config_), key);
}

void Settings::load(const std::filesystem::path& yaml_file) {
  load_yaml(list_fields(*config_), yaml_file);
}

std::string Settings::yaml() const {
  return dump_yaml(list_fields(*config_));
}

}  // namespace stillmap
