// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace stillmap {

// Figures for display: a fitting unit, about three digits, and a no-break space between both. A
// value that is not finite is a dash.

inline constexpr const char* kDash = "\xE2\x80\x93";

[[nodiscard]] std::string length_text(double metres);          ///< "2.13 mm", "1.24 cm", "1.05 m"
[[nodiscard]] std::string duration_text(double milliseconds);  ///< "0.51 ms", "12.3 ms", "1.25 s"
[[nodiscard]] std::string memory_text(double megabytes);       ///< "412 MB", "1.35 GB"
[[nodiscard]] std::string count_text(std::size_t count);       ///< "1,234,567"

/// "99.9 %": rounded down to one decimal, so that only all is 100 %. A dash for a total of 0.
[[nodiscard]] std::string share_text(std::size_t part, std::size_t whole);

}  // namespace stillmap
