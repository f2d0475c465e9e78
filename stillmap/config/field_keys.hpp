// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "stillmap/config/config_io.hpp"

namespace stillmap {

/// The field with that key, or null.
[[nodiscard]] const FieldRef* find_field(std::span<const FieldRef> fields, std::string_view key);

/// The first field of that group, or null when there is no such group.
[[nodiscard]] const FieldRef* find_group(std::span<const FieldRef> fields, std::string_view group);

/// Throws the Error for a key that does not exist, with the nearest key of its group, or of all
/// when there is no such group. `where` ("room.yaml:7", "--set") begins it.
[[noreturn]] void throw_unknown_key(std::span<const FieldRef> fields,
                                    std::string_view key,
                                    std::string_view where);

/// Throws the Error for a group that is given a value.
[[noreturn]] void throw_is_group(const FieldRef& first_of_group,
                                 std::string_view group,
                                 std::string_view where);

}  // namespace stillmap
