// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "stillmap/core/images.hpp"
#include "tooling/ros/ros_message.hpp"

namespace stillmap {

/// The type of a message with an image.
enum class RosImageType {
  kPlain,      ///< sensor_msgs/Image
  kCompressed  ///< sensor_msgs/CompressedImage
};

/// What an image shows.
enum class RosImageKind { kColor, kGray, kDepth, kOther };

/// What an image shows, by its encoding.
[[nodiscard]] RosImageKind ros_image_kind(const RosImage& image);
[[nodiscard]] RosImageKind ros_image_kind(const RosCompressedImage& image);

/// Decodes rgb8, bgr8, 8UC3 (blue first), rgba8, bgra8, mono8 and 8UC1, JPEG and PNG. Throws
/// DamagedImage, beginning with `place`, for an image with fewer bytes than its size needs, and
/// Error for another encoding.
[[nodiscard]] ColorImage decode_ros_color(const RosImage& image, const std::string& place);
[[nodiscard]] ColorImage decode_ros_color(const RosCompressedImage& image,
                                          const std::string& place);

/// Decodes 16UC1 and mono16, in units of 1 / `depth_factor` metres, 32FC1, in metres, and the PNG
/// of both (compressed_depth_image_transport). What is not finite or not positive, and 65535 of 16
/// bits, becomes 0 = missing. Throws as above.
[[nodiscard]] DepthImage decode_ros_depth(const RosImage& image,
                                          double depth_factor,
                                          const std::string& place);
[[nodiscard]] DepthImage decode_ros_depth(const RosCompressedImage& image,
                                          double depth_factor,
                                          const std::string& place);

/// The same of a message as a bag stores it, whose bytes may end too early: DamagedImage.
/// @{
[[nodiscard]] RosImageKind ros_image_kind(std::string_view message,
                                          RosImageType type,
                                          const std::string& place);
[[nodiscard]] ColorImage decode_ros_color(std::string_view message,
                                          RosImageType type,
                                          const std::string& place);
[[nodiscard]] DepthImage decode_ros_depth(std::string_view message,
                                          RosImageType type,
                                          double depth_factor,
                                          const std::string& place);
/// @}

}  // namespace stillmap
