// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace stillmap {

/// Whether two classes are equal or such that networks take one for the other: a chair and a couch.
[[nodiscard]] bool similar_classes(std::string_view a, std::string_view b);

}  // namespace stillmap
