// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace stillmap {

struct SystemConfig;

/// The settings of a System, by their keys. All have defaults; docs/settings.md lists them
/// with unit, range and meaning.
///
///   Settings settings;
///   settings.set("dynamics.mode", "paper");
///   settings.set("cloud.voxel_size_m", "0.02");
class Settings {
 public:
  /// The defaults.
  Settings();
  /// From the typed settings that the library's code uses.
  Settings(const SystemConfig& config);  // NOLINT(google-explicit-constructor): the same values
  /// Copies are independent.
  /// @{
  Settings(const Settings& other);
  Settings& operator=(const Settings& other);
  /// @}
  ~Settings();

  /// Sets one value from its text. Throws Error that names the key, and what was expected, for an
  /// unknown key or a value of the wrong type or range.
  Settings& set(std::string_view key, std::string_view value);
  /// The value of a key as text. Throws Error for an unknown key.
  [[nodiscard]] std::string get(std::string_view key) const;

  /// Sets the values that a YAML file names. Throws Error with file, line and key.
  void load(const std::filesystem::path& yaml_file);
  /// All values as YAML, which load() reads back to the same bits.
  [[nodiscard]] std::string yaml() const;

  /// The typed settings (session/system_config.hpp), for the library's code.
  [[nodiscard]] const SystemConfig& config() const { return *config_; }

 private:
  std::unique_ptr<SystemConfig> config_;
};

}  // namespace stillmap
