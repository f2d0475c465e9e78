// SPDX-License-Identifier: Apache-2.0
#include "tooling/ros/ros_image.hpp"

#include <array>
#include <cmath>
#include <cstring>

#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/io/depth_units.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/jpeg_codec.hpp"
#include "stillmap/io/png_codec.hpp"

namespace stillmap {
namespace {

constexpr int kNoConversion = -1;

struct Encoding {
  std::string_view name;
  RosImageKind kind;
  int type;        // of OpenCV
  int conversion;  // of OpenCV, to RGB
};

constexpr std::array<Encoding, 10> kEncodings = {
    {{"rgb8", RosImageKind::kColor, CV_8UC3, kNoConversion},
     {"bgr8", RosImageKind::kColor, CV_8UC3, cv::COLOR_BGR2RGB},
     {"8UC3", RosImageKind::kColor, CV_8UC3, cv::COLOR_BGR2RGB},
     {"rgba8", RosImageKind::kColor, CV_8UC4, cv::COLOR_RGBA2RGB},
     {"bgra8", RosImageKind::kColor, CV_8UC4, cv::COLOR_BGRA2RGB},
     {"mono8", RosImageKind::kGray, CV_8UC1, cv::COLOR_GRAY2RGB},
     {"8UC1", RosImageKind::kGray, CV_8UC1, cv::COLOR_GRAY2RGB},
     {"16UC1", RosImageKind::kDepth, CV_16UC1, kNoConversion},
     {"mono16", RosImageKind::kDepth, CV_16UC1, kNoConversion},
     {"32FC1", RosImageKind::kDepth, CV_32FC1, kNoConversion}}};

const Encoding* find_encoding(std::string_view name) {
  for (const Encoding& encoding : kEncodings) {
    if (encoding.name == name) return &encoding;
  }
  return nullptr;
}

// The pixels of a message, copied.
cv::Mat pixels_of(const RosImage& image, const Encoding& encoding, const std::string& place) {
  constexpr auto kMost = static_cast<std::uint32_t>(kMaxImageSidePx);
  if (image.width_px == 0 || image.height_px == 0 || image.width_px > kMost ||
      image.height_px > kMost) {
    throw DamagedImage("{}: an image of {}x{} pixels", place, image.width_px, image.height_px);
  }
  const std::size_t row_bytes =
      image.width_px * static_cast<std::size_t>(CV_ELEM_SIZE(encoding.type));
  const std::size_t needed = std::size_t{image.row_bytes} * (image.height_px - 1) + row_bytes;
  if (image.row_bytes < row_bytes || image.pixels.size() < needed) {
    throw DamagedImage("{}: {} bytes, expected {}x{} pixels of {}",
                       place,
                       image.pixels.size(),
                       image.width_px,
                       image.height_px,
                       encoding.name);
  }
  if (image.big_endian && CV_ELEM_SIZE1(encoding.type) > 1) {
    throw Error("{}: big-endian pixels, expected little-endian ones", place);
  }
  cv::Mat pixels(
      static_cast<int>(image.height_px), static_cast<int>(image.width_px), encoding.type);
  for (int row = 0; row < pixels.rows; ++row) {
    std::memcpy(pixels.ptr(row),
                image.pixels.data() + static_cast<std::size_t>(row) * image.row_bytes,
                row_bytes);
  }
  return pixels;
}

template <class Metres>
cv::Mat1f converted(const cv::Mat& stored, const Metres& metres) {
  cv::Mat1f depth(stored.size());
  for (int row = 0; row < stored.rows; ++row) {
    for (int column = 0; column < stored.cols; ++column) {
      const float value = metres(row, column);
      depth(row, column) = std::isfinite(value) && value > 0 ? value : 0.0F;
    }
  }
  return depth;
}

cv::Mat1f from_units(const cv::Mat1w& stored, double depth_factor) {
  const float factor = static_cast<float>(depth_factor);
  return converted(stored, [&](int row, int column) {
    const std::uint16_t raw = stored(row, column);
    return raw == kSaturatedDepth ? 0.0F : static_cast<float>(raw) / factor;
  });
}

// A PNG after the header of compressed_depth_image_transport: the number of a format, then the two
// constants with which it stores metres z as a / z + b.
cv::Mat1f from_compressed_depth(std::string_view format,
                                std::string_view file,
                                double depth_factor,
                                const std::string& place) {
  constexpr std::size_t kHeaderBytes = 12, kConstants = 4;
  if (file.size() < kHeaderBytes) throw DamagedImage("{}: {} bytes of depth", place, file.size());
  std::array<float, 2> constants{};
  std::memcpy(constants.data(), file.data() + kConstants, sizeof(constants));
  const cv::Mat1w stored(decode_png(file.substr(kHeaderBytes), PngKind::kGray16, place));
  if (!format.starts_with("32FC1")) return from_units(stored, depth_factor);
  return converted(stored, [&](int row, int column) {
    const std::uint16_t raw = stored(row, column);
    return raw == 0 ? 0.0F : constants[0] / (static_cast<float>(raw) - constants[1]);
  });
}

bool is_compressed_depth(std::string_view format) {
  return format.find("compressedDepth") != std::string_view::npos;
}

}  // namespace

RosImageKind ros_image_kind(const RosImage& image) {
  const Encoding* const encoding = find_encoding(image.encoding);
  return encoding != nullptr ? encoding->kind : RosImageKind::kOther;
}

RosImageKind ros_image_kind(const RosCompressedImage& image) {
  if (is_compressed_depth(image.format)) return RosImageKind::kDepth;
  if (image.format.starts_with("mono8") || image.format.starts_with("8UC1"))
    return RosImageKind::kGray;
  const bool deep = image.format.starts_with("16UC1") || image.format.starts_with("mono16");
  if (deep) return RosImageKind::kDepth;
  return is_jpeg(image.file) || is_png(image.file) ? RosImageKind::kColor : RosImageKind::kOther;
}

ColorImage decode_ros_color(const RosImage& image, const std::string& place) {
  const Encoding* const encoding = find_encoding(image.encoding);
  if (encoding == nullptr || encoding->kind == RosImageKind::kDepth) {
    throw Error("{}: encoding '{}', expected rgb8, bgr8 or mono8", place, image.encoding);
  }
  const cv::Mat pixels = pixels_of(image, *encoding, place);
  if (encoding->conversion == kNoConversion) return ColorImage(cv::Mat3b(pixels));
  cv::Mat3b rgb;
  cv::cvtColor(pixels, rgb, encoding->conversion);
  return ColorImage(rgb);
}

ColorImage decode_ros_color(const RosCompressedImage& image, const std::string& place) {
  return decode_color(image.file, place);
}

DepthImage decode_ros_depth(const RosImage& image, double depth_factor, const std::string& place) {
  const Encoding* const encoding = find_encoding(image.encoding);
  if (encoding == nullptr || encoding->kind != RosImageKind::kDepth) {
    throw Error("{}: encoding '{}', expected 16UC1 or 32FC1", place, image.encoding);
  }
  const cv::Mat pixels = pixels_of(image, *encoding, place);
  if (encoding->type == CV_16UC1) return DepthImage(from_units(cv::Mat1w(pixels), depth_factor));
  const cv::Mat1f metres(pixels);
  return DepthImage(converted(metres, [&](int row, int column) { return metres(row, column); }));
}

DepthImage decode_ros_depth(const RosCompressedImage& image,
                            double depth_factor,
                            const std::string& place) {
  if (is_compressed_depth(image.format)) {
    return DepthImage(from_compressed_depth(image.format, image.file, depth_factor, place));
  }
  return DepthImage(
      from_units(cv::Mat1w(decode_png(image.file, PngKind::kGray16, place)), depth_factor));
}

RosImageKind ros_image_kind(std::string_view message, RosImageType type, const std::string& place) {
  return type == RosImageType::kPlain ? ros_image_kind(parse_ros_image(message, place))
                                      : ros_image_kind(parse_ros_compressed_image(message, place));
}

ColorImage decode_ros_color(std::string_view message, RosImageType type, const std::string& place) {
  return type == RosImageType::kPlain
             ? decode_ros_color(parse_ros_image(message, place), place)
             : decode_ros_color(parse_ros_compressed_image(message, place), place);
}

DepthImage decode_ros_depth(std::string_view message,
                            RosImageType type,
                            double depth_factor,
                            const std::string& place) {
  return type == RosImageType::kPlain
             ? decode_ros_depth(parse_ros_image(message, place), depth_factor, place)
             : decode_ros_depth(parse_ros_compressed_image(message, place), depth_factor, place);
}

}  // namespace stillmap
