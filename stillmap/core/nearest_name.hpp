// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace stillmap {

/// A hint for a misspelt name: "did you mean 'x'?" with the closest known name when its edit
/// distance is at most a third of its length, rounded; else "known: a, b, c". `known` must not be
/// empty.
[[nodiscard]] std::string name_hint(std::string_view misspelt, std::span<const std::string> known);

}  // namespace stillmap
