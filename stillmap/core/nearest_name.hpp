// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace stillmap {

/// The known name that is closest to a misspelt one: "did you mean 'x'?" when one is close (edit
/// distance at most a third of its length, rounded), else "known: a, b, c". `known` is not empty.
[[nodiscard]] std::string name_hint(std::string_view misspelt, std::span<const std::string> known);

}  // namespace stillmap
