// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <opencv2/core/mat.hpp>

namespace stillmap {

/// Images of more than this many pixels a side are refused before anything is allocated for them.
inline constexpr int kMaxImageSidePx = 8192;

/// What the pixels of a PNG are decoded to. A file that holds something else is refused.
enum class PngKind {
  kRgb8,   ///< from 8-bit gray or colour, without palette; transparency is dropped. CV_8UC3
  kGray8,  ///< from 8-bit gray only. CV_8UC1
  kGray16  ///< from 16-bit gray only. CV_16UC1
};

[[nodiscard]] bool is_png(std::string_view bytes);

/// Decodes a whole PNG. `name` stands in the messages. Throws Error for a wrong kind of pixels, a
/// side over kMaxImageSidePx, a truncated or damaged file.
[[nodiscard]] cv::Mat decode_png(std::string_view bytes, PngKind kind, const std::string& name);

/// The same by libpng alone, which decode_png leaves only the rarer kinds and the broken to.
[[nodiscard]] cv::Mat decode_by_libpng(std::string_view bytes,
                                       PngKind kind,
                                       const std::string& name);

/// Encodes CV_8UC3 (RGB), CV_8UC1 or CV_16UC1, without loss; the same image gives the same bytes.
[[nodiscard]] std::string encode_png_bytes(const cv::Mat& image);

}  // namespace stillmap
