// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace stillmap {

// The texts of the files of these names, embedded by embed_text.cmake when building.

[[nodiscard]] std::string_view page_html();  ///< with places for fill_template()
[[nodiscard]] std::string_view page_css();
[[nodiscard]] std::string_view
map_scripts_js();  ///< map_figure.js with the modules that it imports

}  // namespace stillmap
