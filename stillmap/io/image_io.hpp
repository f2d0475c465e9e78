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

/// An image file that is missing, truncated or damaged, as a disk or a recorder may leave one; a
/// good image of the wrong kind or size is a plain Error.
class DamagedImage : public Error {
 public:
  using Error::Error;
};

// Readers go by a file's content, never by its name. They throw Error, naming the file, what it
// holds and what was expected: DamagedImage for one that is missing, truncated or damaged, a plain
// Error for one of another kind or of more than 8192 pixels a side. All are stateless and may run
// in any number of threads.

/// A PNG (8-bit gray or RGB, transparency dropped) or JPEG, as RGB.
[[nodiscard]] ColorImage read_color(const std::filesystem::path& path);

/// The same from the bytes of a file that is elsewhere, in an archive; `name` stands in the
/// messages.
[[nodiscard]] ColorImage decode_color(std::string_view bytes, const std::string& name);

/// A 16-bit gray PNG. Metres are the stored value / depth_factor; 0 stays 0 = missing.
[[nodiscard]] DepthImage read_depth(const std::filesystem::path& path, double depth_factor);

/// An 8-bit gray PNG whose pixels are numbers, such as the ids of objects.
[[nodiscard]] cv::Mat1b read_mask(const std::filesystem::path& path);

/// `quality` is from 1 to 100.
[[nodiscard]] std::vector<std::uint8_t> encode_jpeg(const ColorImage& color, int quality);

/// 8-bit RGB PNG.
[[nodiscard]] std::string encode_png(const ColorImage& color);

/// 8-bit gray PNG, the counterpart of read_mask.
[[nodiscard]] std::string encode_mask_png(const cv::Mat1b& mask);

/// 16-bit PNG of metres * depth_factor, rounded to the nearest. What is missing (0, negative, not
/// finite) or beyond the range of 16 bits becomes 0.
[[nodiscard]] std::string encode_depth_png(const DepthImage& depth, double depth_factor);

}  // namespace stillmap
