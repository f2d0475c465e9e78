// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace stillmap {

/// The numbers of a text, separated by blanks, commas and line ends; they may be infinite or nan.
/// Throws Error, beginning with `place`, for anything else in it, and for another count than
/// `expected` (0: any).
[[nodiscard]] std::vector<double> numbers_in(std::string_view text,
                                             const std::string& place,
                                             std::size_t expected = 0);

}  // namespace stillmap
