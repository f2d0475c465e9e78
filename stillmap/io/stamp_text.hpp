// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// The longest text of a stamp: a name of a file has room for it.
inline constexpr std::size_t kMaxStampLength = 64;

/// The stamp that a text tells: a finite number in decimal notation, such as "1341846313.592026",
/// "-0.5", "12." or "1.5e9", of at most kMaxStampLength characters. Nothing for any other text.
/// All files with stamps are read with it. Such a text is a safe name of a file.
[[nodiscard]] std::optional<Stamp> parse_stamp(std::string_view text);

/// The text of a stamp in files: its own, or six decimals where no file gave it one. parse_stamp
/// reads it.
[[nodiscard]] std::string stamp_text(const Stamp& stamp);

}  // namespace stillmap
