// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "stillmap/config/config_io.hpp"

namespace stillmap {

/// The field with the full name `key`, or null.
[[nodiscard]] const FieldRef* find_field(std::span<const FieldRef> fields, std::string_view key);

/// The first field of the group `group`, or null when there is no such group.
[[nodiscard]] const FieldRef* find_group(std::span<const FieldRef> fields, std::string_view group);

/// Throws the Error for an unknown key. Its text begins with `where` ("room.yaml:7") and hints at
/// the nearest key of the key's group, or of all keys when there is no such group.
[[noreturn]] void throw_unknown_key(std::span<const FieldRef> fields,
                                    std::string_view key,
                                    std::string_view where);

/// Throws the Error for a value given to a whole group.
[[noreturn]] void throw_is_group(const FieldRef& first_of_group,
                                 std::string_view group,
                                 std::string_view where);

}  // namespace stillmap
