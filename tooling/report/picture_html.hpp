// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "stillmap/core/images.hpp"

namespace stillmap {

/// A picture embedded in HTML. `alt` is plain text, `caption` HTML; `overlay` is an SVG of the
/// picture's proportions that is drawn over it, or empty.
[[nodiscard]] std::string figure_html(const ColorImage& picture,
                                      const std::string& alt,
                                      const std::string& caption,
                                      const std::string& overlay = "");

}  // namespace stillmap
