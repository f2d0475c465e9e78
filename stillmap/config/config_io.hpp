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

/// One configuration value in place: where it is stored, and what is known of it. It points into
/// the struct it was listed from and must not outlive it.
struct FieldRef {
  std::string key;  ///< full name, groups joined by dots: "tracking.features"
  std::variant<bool*, int*, std::uint32_t*, double*, std::string*> value;
  FieldInfo info;
};

/// The visitor that turns a struct's `fields` (see core/fields.hpp) into a flat list.
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

/// All values of a configuration struct in the order it names them.
template <class Config>
[[nodiscard]] std::vector<FieldRef> list_fields(Config& config) {
  FieldLister lister;
  Config::fields(config, lister);
  return lister.take();
}

/// Sets the values that a YAML file names; groups are nested maps. Throws Error naming file, line
/// and key for anything but a correct file: an unknown or repeated key, a value of the wrong type
/// or out of its range, a construct other than nested maps of scalars, more than 1 MiB. The values
/// read before the mistake are set by then.
void load_yaml(std::span<const FieldRef> fields, const std::filesystem::path& file);

/// The same from the text of such a file; `name` stands for the file's in messages.
void load_yaml_text(std::span<const FieldRef> fields,
                    std::string_view text,
                    const std::string& name);

/// Sets one value from the "key=value" of the command line's --set, as strictly as load_yaml.
void set_value(std::span<const FieldRef> fields, std::string_view assignment);

/// Sets one value from its text. `where` begins the messages.
void set_value(std::span<const FieldRef> fields,
               std::string_view key,
               std::string_view value,
               std::string_view where);

/// The value of a key as text. Throws Error for an unknown key.
[[nodiscard]] std::string value_text(std::span<const FieldRef> fields, std::string_view key);

/// The current values as YAML with a comment on each line. load_yaml reads back the same bits.
[[nodiscard]] std::string dump_yaml(std::span<const FieldRef> fields);

/// A table for people: key, current value, unit, what is allowed, meaning.
[[nodiscard]] std::string describe(std::span<const FieldRef> fields);

}  // namespace stillmap
