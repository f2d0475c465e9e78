// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "stillmap/config/config_io.hpp"

namespace stillmap {

/// Whether a value is written in quotes. A quoted value is a text, never a number or a truth value.
enum class Quoting { kPlain, kQuoted };

/// The value as text; numbers have the fewest digits that read back to the same bits.
[[nodiscard]] std::string format_value(const FieldRef& field);

/// Whether the value is a text (and so is written in quotes).
[[nodiscard]] bool is_text(const FieldRef& field);

/// The values that the field allows: "0.001 to 1", "off, mask, full", "at least 0", "true, false";
/// empty when every value of its type is allowed.
[[nodiscard]] std::string allowed_values(const FieldRef& field);

/// The expectation in an error message: "a whole number from 100 to 10000", "a number from 0.1 to 9
/// m".
[[nodiscard]] std::string expectation(const FieldRef& field);

/// Sets the field. Throws Error, beginning with `where` ("room.yaml:7"), for a text that is not a
/// value of the field's type and range.
void assign(const FieldRef& field, std::string_view text, Quoting quoting, std::string_view where);

/// A text from outside, shortened and without control characters, fit for one line of a message.
[[nodiscard]] std::string printable(std::string_view text);

/// The number of bytes before the first that is not part of UTF-8 text; control characters other
/// than tab and line ends are not text. The size of `bytes` when all of it is text.
[[nodiscard]] std::size_t text_prefix(std::string_view bytes);

}  // namespace stillmap
