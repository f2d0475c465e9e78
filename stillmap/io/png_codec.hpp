// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <opencv2/core/mat.hpp>

namespace stillmap {

/// Greatest width and height of an image, pixels. Larger images are refused before anything is
/// allocated.
inline constexpr int kMaxImageSidePx = 8192;

/// The type of pixels that a PNG is decoded to. A file with other pixels is refused.
enum class PngKind {
  kRgb8,   ///< from 8-bit gray or colour, without palette; transparency is dropped. CV_8UC3
  kGray8,  ///< from 8-bit gray only. CV_8UC1
  kGray16  ///< from 16-bit gray only. CV_16UC1
};

[[nodiscard]] bool is_png(std::string_view bytes);

/// Decodes a whole PNG. Messages call it `name`. Throws Error for pixels of another kind, a side
/// over kMaxImageSidePx, and a truncated or damaged file.
[[nodiscard]] cv::Mat decode_png(std::string_view bytes, PngKind kind, const std::string& name);

/// decode_png() by libpng alone. decode_png() uses it for the rarer kinds and for damaged files.
[[nodiscard]] cv::Mat decode_by_libpng(std::string_view bytes,
                                       PngKind kind,
                                       const std::string& name);

/// Encodes CV_8UC3 (RGB), CV_8UC1 or CV_16UC1 without loss. The same image gives the same bytes.
[[nodiscard]] std::string encode_png_bytes(const cv::Mat& image);

}  // namespace stillmap
