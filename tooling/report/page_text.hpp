// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace stillmap {

/// Escapes text for an element or a quoted attribute: & < > " ' as entities; bytes that are not
/// UTF-8, and control characters except line end and tab, as U+FFFD.
[[nodiscard]] std::string html_escape(std::string_view text);

/// RFC 4648, with padding, without line ends.
[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

/// `text` with each `{{name}}` replaced by its value; values are not searched again, so they may
/// hold any text. Throws InternalError for a name without a value: templates are our own.
[[nodiscard]] std::string fill_template(std::string_view text,
                                        const std::map<std::string, std::string>& values);

}  // namespace stillmap
