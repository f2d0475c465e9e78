// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

namespace stillmap {

// The texts of the files of these names, embedded when building.
[[nodiscard]] std::string_view index_html();
[[nodiscard]] std::string_view viewer_css();
[[nodiscard]] std::string_view main_js();
[[nodiscard]] std::string_view panel_js();
[[nodiscard]] std::string_view picture_js();
[[nodiscard]] std::string_view socket_js();

/// A file of the page.
struct PageFile {
  std::string_view text;
  std::string_view type;  ///< of its content
};

/// The file of that name; "" is the page itself.
[[nodiscard]] std::optional<PageFile> page_file(std::string_view name);

}  // namespace stillmap
