// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace stillmap {

[[nodiscard]] bool is_jpeg(std::string_view bytes);

struct DecodedJpeg {
  cv::Mat3b rgb;
  std::string warning;  ///< what is wrong with the file beside the pixels; empty if nothing is
};

/// Decodes a gray or colour JPEG to RGB. Messages call it `name`. Throws Error for CMYK, for a side
/// over kMaxImageSidePx (png_codec.hpp), and where a pixel cannot be decoded: the library would
/// warn and fill it with gray. A file that only lacks its end, or has stray bytes before it, as
/// cameras with motion JPEG give, is decoded, with a warning.
[[nodiscard]] DecodedJpeg decode_jpeg(std::string_view bytes, const std::string& name);

/// Encodes RGB without chroma subsampling. `quality` is from 1 to 100.
[[nodiscard]] std::vector<std::uint8_t> encode_jpeg_bytes(const cv::Mat3b& rgb, int quality);

}  // namespace stillmap
