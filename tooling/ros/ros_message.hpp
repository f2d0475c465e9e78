// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace stillmap {

// Messages of ROS 1's sensor_msgs as a bag stores them. Parsers throw DamagedImage, beginning
// with `place`, for bytes that end too early; they copy no pixels and allocate nothing larger than
// the bytes.

/// The time in a message's header.
struct RosTime {
  std::uint32_t seconds = 0;
  std::uint32_t nanoseconds = 0;
};

/// sensor_msgs/Image.
struct RosImage {
  RosTime stamp;
  std::uint32_t height_px = 0;
  std::uint32_t width_px = 0;
  std::string_view encoding;
  bool big_endian = false;
  std::uint32_t row_bytes = 0;
  std::string_view pixels;  ///< of the message
};

/// sensor_msgs/CompressedImage.
struct RosCompressedImage {
  RosTime stamp;
  std::string_view format;
  std::string_view file;  ///< of the message
};

/// sensor_msgs/CameraInfo.
struct RosCameraInfo {
  std::uint32_t height_px = 0;
  std::uint32_t width_px = 0;
  std::string distortion_model;
  std::vector<double> distortion;
  std::array<double, 9> intrinsics = {};   ///< K, row by row
  std::array<double, 12> projection = {};  ///< P, row by row
};

[[nodiscard]] RosTime parse_ros_stamp(std::string_view message, const std::string& place);
[[nodiscard]] RosImage parse_ros_image(std::string_view message, const std::string& place);
[[nodiscard]] RosCompressedImage parse_ros_compressed_image(std::string_view message,
                                                            const std::string& place);
[[nodiscard]] RosCameraInfo parse_ros_camera_info(std::string_view message,
                                                  const std::string& place);
/// std_msgs/Float32.
[[nodiscard]] float parse_ros_float(std::string_view message, const std::string& place);

}  // namespace stillmap
