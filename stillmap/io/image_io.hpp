// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/core/images.hpp"

namespace stillmap {

/// The error for an image file that is missing, truncated or damaged. For an undamaged image of the
/// wrong kind or size it is a plain Error.
class DamagedImage : public Error {
 public:
  using Error::Error;
};

// Readers look at the content of a file, never at its name. They throw Error, naming the file, its
// content and what was expected: DamagedImage for a missing, truncated or damaged file, a plain
// Error for another kind of image or more than 8192 pixels a side. All functions are stateless and
// safe to use from several threads.

/// Reads a PNG (8-bit gray or RGB; transparency is dropped) or JPEG as RGB.
[[nodiscard]] ColorImage read_color(const std::filesystem::path& path);

/// A colour image and what is wrong with its file beside the pixels.
struct ColorFile {
  ColorImage color;
  std::string warning;  ///< one line that begins with the file; empty if nothing is wrong
};

/// read_color with what is wrong. A JPEG is damaged only where pixels cannot be decoded; one that
/// lacks its end marker, or has stray bytes before it, is read with a warning.
[[nodiscard]] ColorFile read_color_file(const std::filesystem::path& path);

/// read_color for the bytes of a file, such as one in an archive. Messages call it `name`.
[[nodiscard]] ColorImage decode_color(std::string_view bytes, const std::string& name);

/// Reads a 16-bit gray PNG. Metres are the stored value / depth_factor; 0 and 65535 mean that
/// nothing was measured, and become 0.
[[nodiscard]] DepthImage read_depth(const std::filesystem::path& path, double depth_factor);

/// Reads an 8-bit gray PNG whose pixels are numbers, such as ids of objects.
[[nodiscard]] cv::Mat1b read_mask(const std::filesystem::path& path);
/// Throws Error, naming the mask's file, where a mask is not as large as its image.
void check_mask_size(const cv::Mat1b& mask, cv::Size image, const std::filesystem::path& path);

/// Encodes a JPEG. `quality` is from 1 to 100.
[[nodiscard]] std::vector<std::uint8_t> encode_jpeg(const ColorImage& color, int quality);

/// Encodes an 8-bit RGB PNG.
[[nodiscard]] std::string encode_png(const ColorImage& color);

/// Encodes an 8-bit gray PNG, which read_mask reads.
[[nodiscard]] std::string encode_mask_png(const cv::Mat1b& mask);

/// Encodes a 16-bit PNG of metres * depth_factor, rounded to the nearest. Missing depth (0,
/// negative, not finite) and depth from 65535 units on become 0.
[[nodiscard]] std::string encode_depth_png(const DepthImage& depth, double depth_factor);

}  // namespace stillmap
