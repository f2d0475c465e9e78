// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <string_view>

#include <linux/videodev2.h>
#include <opencv2/imgproc.hpp>

#include "stillmap/io/depth_units.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/jpeg_codec.hpp"
#include "tooling/devices/video_node.hpp"

namespace stillmap {
namespace {

void check_undamaged(const RawVideo& raw, const std::string& place) {
  if (raw.damaged) throw DamagedImage("{}: an image that the driver calls damaged", place);
}

// The pixels of an image, copied; `type` is OpenCV's.
cv::Mat pixels_of(const RawVideo& raw,
                  const VideoLayout& layout,
                  int type,
                  const std::string& place) {
  cv::Mat pixels(layout.size, type);
  const std::size_t row_bytes = static_cast<std::size_t>(pixels.cols) * pixels.elemSize();
  const std::size_t needed =
      layout.row_bytes * (static_cast<std::size_t>(pixels.rows) - 1) + row_bytes;
  if (layout.row_bytes < row_bytes || raw.bytes.size() < needed) {
    throw DamagedImage("{}: {} bytes in rows of {}, expected {}x{} pixels of {}",
                       place,
                       raw.bytes.size(),
                       layout.row_bytes,
                       pixels.cols,
                       pixels.rows,
                       format_name(layout.format));
  }
  for (int v = 0; v < pixels.rows; ++v) {
    std::memcpy(pixels.ptr(v),
                raw.bytes.data() + static_cast<std::size_t>(v) * layout.row_bytes,
                row_bytes);
  }
  return pixels;
}

cv::Mat3b converted(const cv::Mat& pixels, int conversion) {
  cv::Mat3b rgb;
  cv::cvtColor(pixels, rgb, conversion);
  return rgb;
}

}  // namespace

ColorImage video_color(const RawVideo& raw, const VideoLayout& layout, const std::string& place) {
  check_undamaged(raw, place);
  switch (layout.format) {
    case V4L2_PIX_FMT_RGB24:
      return ColorImage(cv::Mat3b(pixels_of(raw, layout, CV_8UC3, place)));
    case V4L2_PIX_FMT_YUYV:
      return ColorImage(converted(pixels_of(raw, layout, CV_8UC2, place), cv::COLOR_YUV2RGB_YUY2));
    case V4L2_PIX_FMT_UYVY:
      return ColorImage(converted(pixels_of(raw, layout, CV_8UC2, place), cv::COLOR_YUV2RGB_UYVY));
    case V4L2_PIX_FMT_GREY:
      return ColorImage(converted(pixels_of(raw, layout, CV_8UC1, place), cv::COLOR_GRAY2RGB));
    case V4L2_PIX_FMT_MJPEG:
      return ColorImage(
          decode_jpeg({reinterpret_cast<const char*>(raw.bytes.data()), raw.bytes.size()}, place)
              .rgb);
    default:
      throw Error("{}: {}, expected a format of colour", place, format_name(layout.format));
  }
}

DepthImage video_depth(const RawVideo& raw,
                       const VideoLayout& layout,
                       double depth_factor,
                       const std::string& place) {
  check_undamaged(raw, place);
  return depth_of_units(cv::Mat1w(pixels_of(raw, layout, CV_16UC1, place)), depth_factor);
}

}  // namespace stillmap
