// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "stillmap/core/fields.hpp"

namespace stillmap {

/// A setting in place: its full name, its storage and its documentation. It points into the struct
/// that it was listed from and must not outlive it.
struct FieldRef {
  std::string key;  ///< groups and name joined by dots: "tracking.features"
  std::variant<bool*, int*, std::uint32_t*, double*, std::string*> value;
  FieldInfo info;
};

/// The visitor that turns the `fields` of a struct (see core/fields.hpp) into a flat list.
class FieldLister {
 public:
  template <class T>
  void operator()(std::string_view name, T& value, FieldInfo info) {
    fields_.push_back({prefix_ + std::string(name), &value, std::move(info)});
  }

  template <class Group>
  void group(std::string_view name, Group& nested) {
    const std::string outer = prefix_;
    prefix_ += std::string(name) + ".";
    Group::fields(nested, *this);
    prefix_ = outer;
  }

  [[nodiscard]] std::vector<FieldRef> take() { return std::move(fields_); }

 private:
  std::string prefix_;
  std::vector<FieldRef> fields_;
};

/// All settings of a configuration struct, in the order in which its `fields` name them.
template <class Config>
[[nodiscard]] std::vector<FieldRef> list_fields(Config& config) {
  FieldLister lister;
  Config::fields(config, lister);
  return lister.take();
}

/// Sets the values that a YAML file names; groups are nested maps. Throws Error naming file, line
/// and key for an unknown or repeated key, a value of the wrong type or out of its range, a
/// construct other than nested maps of scalars, or a file of more than 1 MiB. Values read before
/// the mistake stay set.
void load_yaml(std::span<const FieldRef> fields, const std::filesystem::path& file);

/// What a key means that is no setting.
enum class UnknownKeys {
  kRefuse,  ///< a mistake
  kSkip,    ///< a setting of another version: it and its value are skipped
};

/// load_yaml for the text of such a file. Messages call the file `name`.
void load_yaml_text(std::span<const FieldRef> fields,
                    std::string_view text,
                    const std::string& name,
                    UnknownKeys unknown = UnknownKeys::kRefuse);

/// Sets one value from a text "key=value", as strictly as load_yaml. `where` says in messages where
/// the text stood.
void set_value(std::span<const FieldRef> fields,
               std::string_view assignment,
               std::string_view where = "setting");

/// Sets one value from its text. `where` begins the messages.
void set_value(std::span<const FieldRef> fields,
               std::string_view key,
               std::string_view value,
               std::string_view where);

/// The value of a key as text. Throws Error for an unknown key.
[[nodiscard]] std::string value_text(std::span<const FieldRef> fields, std::string_view key);

/// The current values as YAML, with the meaning of each as a comment. load_yaml reads the same bits
/// back.
[[nodiscard]] std::string dump_yaml(std::span<const FieldRef> fields);

/// The settings that people change (FieldInfo::common), in the order given.
[[nodiscard]] std::vector<FieldRef> common_fields(std::span<const FieldRef> fields);

/// A table for people: for each setting a line with key, value, unit and allowed values, and its
/// meaning on indented lines. Lines have at most 100 characters.
[[nodiscard]] std::string describe(std::span<const FieldRef> fields);

}  // namespace stillmap
