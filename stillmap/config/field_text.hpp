// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "stillmap/config/config_io.hpp"

namespace stillmap {

/// Is the text bare or in quotes? A quoted text is never a number or a truth value.
enum class Quoting { kPlain, kQuoted };

/// The value as text: numbers in the fewest digits that read back to the same bits.
[[nodiscard]] std::string format_value(const FieldRef& field);

/// Whether the value is a text (and so is written in quotes).
[[nodiscard]] bool is_text(const FieldRef& field);

/// What the field takes: "0.001 to 1", "off, mask, full", "at least 0", "true, false"; empty when
/// anything of its type goes.
[[nodiscard]] std::string allowed_values(const FieldRef& field);

/// What an error says was expected: "a whole number from 100 to 10000", "a number from 0.1 to 9 m".
[[nodiscard]] std::string expectation(const FieldRef& field);

/// Sets the field. `where` ("room.yaml:7", "--set") begins the Error thrown for a text that is not
/// a value of the field's type and range.
void assign(const FieldRef& field, std::string_view text, Quoting quoting, std::string_view where);

/// The text of an outside source, shortened and without control characters, for one line.
[[nodiscard]] std::string printable(std::string_view text);

/// Whether all of it is UTF-8 without control characters other than tab and line ends; if not, the
/// offset of the first byte that is not.
[[nodiscard]] std::size_t text_prefix(std::string_view bytes);

}  // namespace stillmap
