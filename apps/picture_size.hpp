// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace stillmap {

struct PictureSize {
  int width_px = 0;
  int height_px = 0;
};

/// Reads the value of --size, such as "640x480". Throws Error for any other text, and for sides
/// below 32 or above 4096 pixels: smaller images show nothing, and no depth camera has larger ones.
[[nodiscard]] PictureSize parse_picture_size(const std::string& text);

}  // namespace stillmap
