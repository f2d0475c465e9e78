// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/picture_html.hpp"

#include <cstdint>
#include <vector>

#include <fmt/core.h>

#include "stillmap/io/image_io.hpp"
#include "tooling/report/page_text.hpp"

namespace stillmap {

std::string figure_html(const ColorImage& picture,
                        const std::string& alt,
                        const std::string& caption,
                        const std::string& overlay) {
  constexpr int kJpegQuality = 82;
  const std::vector<std::uint8_t> jpeg = encode_jpeg(picture, kJpegQuality);
  return fmt::format(
      "<figure><div class=\"picture\"><img src=\"data:image/jpeg;base64,{}\" width=\"{}\" "
      "height=\"{}\" alt=\"{}\">{}</div><figcaption>{}</figcaption></figure>",
      base64(jpeg),
      picture.mat.cols,
      picture.mat.rows,
      html_escape(alt),
      overlay,
      caption);
}

}  // namespace stillmap
