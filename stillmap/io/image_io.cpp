// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/image_io.hpp"

#include <cmath>
#include <system_error>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/depth_units.hpp"
#include "stillmap/io/jpeg_codec.hpp"
#include "stillmap/io/png_codec.hpp"

namespace stillmap {
namespace {

// Enough for 8192 x 8192 pixels of 24 bits that do not compress at all.
constexpr std::size_t kMaxImageFileBytes = std::size_t{256} << 20U;

std::string read_image_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {  // a pipe would make the reader wait
    throw DamagedImage("{}: no such file, expected an image", path.string());
  }
  std::string bytes = read_file(path, kMaxImageFileBytes);
  if (bytes.empty()) throw DamagedImage("{}: empty file, expected an image", path.string());
  return bytes;
}

ColorFile decode_color_file(std::string_view bytes, const std::string& name) {
  if (is_jpeg(bytes)) {
    DecodedJpeg jpeg = decode_jpeg(bytes, name);
    std::string warning = jpeg.warning.empty() ? "" : fmt::format("{}: {}", name, jpeg.warning);
    return {ColorImage(std::move(jpeg.rgb)), std::move(warning)};
  }
  if (is_png(bytes)) return {ColorImage(cv::Mat3b(decode_png(bytes, PngKind::kRgb8, name))), ""};
  throw DamagedImage("{}: neither PNG nor JPEG, expected a colour image", name);
}

}  // namespace

ColorImage read_color(const std::filesystem::path& path) {
  return read_color_file(path).color;
}

ColorFile read_color_file(const std::filesystem::path& path) {
  return decode_color_file(read_image_file(path), path.string());
}

ColorImage decode_color(std::string_view bytes, const std::string& name) {
  return decode_color_file(bytes, name).color;
}

DepthImage read_depth(const std::filesystem::path& path, double depth_factor) {
  STILLMAP_CHECK(depth_factor > 0.0);
  const std::string bytes = read_image_file(path);
  if (!is_png(bytes)) {
    throw DamagedImage("{}: not a PNG, expected a 16-bit depth PNG", path.string());
  }
  return depth_of_units(cv::Mat1w(decode_png(bytes, PngKind::kGray16, path.string())),
                        depth_factor);
}

cv::Mat1b read_mask(const std::filesystem::path& path) {
  const std::string bytes = read_image_file(path);
  if (!is_png(bytes)) throw Error("{}: not a PNG, expected an 8-bit mask PNG", path.string());
  return cv::Mat1b(decode_png(bytes, PngKind::kGray8, path.string()));
}

void check_mask_size(const cv::Mat1b& mask, cv::Size image, const std::filesystem::path& path) {
  if (mask.size() == image) return;
  throw Error("{}: {}x{} pixels, expected {}x{} as the images have",
              path.string(),
              mask.cols,
              mask.rows,
              image.width,
              image.height);
}

std::vector<std::uint8_t> encode_jpeg(const ColorImage& color, int quality) {
  return encode_jpeg_bytes(color.mat, quality);
}

std::string encode_png(const ColorImage& color) {
  return encode_png_bytes(color.mat);
}

std::string encode_mask_png(const cv::Mat1b& mask) {
  return encode_png_bytes(mask);
}

std::string encode_depth_png(const DepthImage& depth, double depth_factor) {
  STILLMAP_CHECK(depth_factor > 0.0);
  cv::Mat1w raw(depth.mat.size());
  for (int v = 0; v < raw.rows; ++v) {
    for (int u = 0; u < raw.cols; ++u) {
      const double value = std::round(static_cast<double>(depth.mat(v, u)) * depth_factor);
      const bool fits = value >= 0.0 && value < kSaturatedDepth;  // false for NaN
      raw(v, u) = fits ? static_cast<std::uint16_t>(value) : std::uint16_t{0};
    }
  }
  return encode_png_bytes(raw);
}

}  // namespace stillmap
