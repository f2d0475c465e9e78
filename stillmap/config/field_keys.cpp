// SPDX-License-Identifier: Apache-2.0
#include "stillmap/config/field_keys.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "stillmap/config/field_text.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/core/nearest_name.hpp"

namespace stillmap {
namespace {

bool is_in_group(const FieldRef& field, std::string_view group) {
  return field.key.size() > group.size() && field.key.starts_with(group) &&
         field.key[group.size()] == '.';
}

// The full names of the keys and groups directly inside a group; "" is the whole configuration.
std::vector<std::string> members(std::span<const FieldRef> fields, std::string_view group) {
  std::vector<std::string> names;
  for (const FieldRef& field : fields) {
    if (!group.empty() && !is_in_group(field, group)) continue;
    const std::size_t start = group.empty() ? 0 : group.size() + 1;
    const std::string name = field.key.substr(0, field.key.find('.', start));
    if (names.empty() || names.back() != name) names.push_back(name);
  }
  return names;
}

std::vector<std::string> all_keys(std::span<const FieldRef> fields) {
  std::vector<std::string> keys;
  for (const FieldRef& field : fields) keys.push_back(field.key);
  return keys;
}

}  // namespace

const FieldRef* find_field(std::span<const FieldRef> fields, std::string_view key) {
  const auto found = std::ranges::find(fields, key, &FieldRef::key);
  return found == fields.end() ? nullptr : &*found;
}

const FieldRef* find_group(std::span<const FieldRef> fields, std::string_view group) {
  const auto found = std::ranges::find_if(
      fields, [&](const FieldRef& field) { return is_in_group(field, group); });
  return found == fields.end() ? nullptr : &*found;
}

void throw_unknown_key(std::span<const FieldRef> fields,
                       std::string_view key,
                       std::string_view where) {
  const std::size_t dot = key.rfind('.');
  const std::string_view parent = dot == std::string_view::npos ? "" : key.substr(0, dot);
  const bool parent_known = parent.empty() || find_group(fields, parent) != nullptr;
  const std::vector<std::string> candidates =
      parent_known ? members(fields, parent) : all_keys(fields);
  const std::string shown = printable(key);
  throw Error("{}: unknown key '{}': {}",
              where,
              shown,
              candidates.empty() ? "there are no keys" : name_hint(shown, candidates));
}

void throw_is_group(const FieldRef& first_of_group,
                    std::string_view group,
                    std::string_view where) {
  throw Error("{}: '{}' is a group of keys such as '{}' and takes no value itself",
              where,
              group,
              first_of_group.key);
}

}  // namespace stillmap
