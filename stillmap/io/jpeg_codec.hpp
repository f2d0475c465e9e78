// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace stillmap {

[[nodiscard]] bool is_jpeg(std::string_view bytes);

/// Decodes a gray or colour JPEG to RGB. Messages call it `name`. Throws Error for CMYK, for a side
/// over kMaxImageSidePx (png_codec.hpp) and for a truncated or damaged file, even where the library
/// would only warn and fill the rest with gray.
[[nodiscard]] cv::Mat3b decode_jpeg(std::string_view bytes, const std::string& name);

/// Encodes RGB without chroma subsampling. `quality` is from 1 to 100.
[[nodiscard]] std::vector<std::uint8_t> encode_jpeg_bytes(const cv::Mat3b& rgb, int quality);

}  // namespace stillmap
