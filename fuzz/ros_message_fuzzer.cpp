// SPDX-License-Identifier: Apache-2.0
// Any bytes are parsed as each of the messages of a bag of ROS 1, or refused; images of them are
// decoded, or refused, and cameras are made of CameraInfo. Bags themselves are read by librosbag.
#include "fuzz/harness.hpp"
#include "tooling/ros/camera_info.hpp"
#include "tooling/ros/ros_image.hpp"
#include "tooling/ros/ros_message.hpp"

namespace stillmap::fuzz {
namespace {

// A small message can announce a large image: no more is decoded than a fuzzer has time for.
constexpr std::size_t kMostPixels = 500000;

void decode_image(std::string_view bytes) {
  for (const RosImageType type : {RosImageType::kPlain, RosImageType::kCompressed}) {
    read_or_refuse([&] { (void)ros_image_kind(bytes, type, "input"); });
  }
  read_or_refuse([&] {
    const RosImage image = parse_ros_image(bytes, "input");
    require(image.pixels.size() <= bytes.size(), "pixels of the message");
    if (std::size_t{image.width_px} * image.height_px > kMostPixels) return;
    read_or_refuse([&] {
      const ColorImage color = decode_ros_color(bytes, RosImageType::kPlain, "input");
      require(!color.mat.empty(), "an image has pixels");
    });
    read_or_refuse([&] {
      const DepthImage depth = decode_ros_depth(bytes, RosImageType::kPlain, 1000, "input");
      require(!depth.mat.empty(), "an image has pixels");
    });
  });
  read_or_refuse([&] { (void)parse_ros_compressed_image(bytes, "input"); });
}

void parse(std::string_view bytes) {
  decode_image(bytes);
  read_or_refuse([&] { (void)parse_ros_stamp(bytes, "input"); });
  read_or_refuse([&] { (void)parse_ros_float(bytes, "input"); });
  read_or_refuse([&] {
    const RosCameraInfo info = parse_ros_camera_info(bytes, "input");
    for (const bool rectified : {false, true}) {
      read_or_refuse([&] {
        const CameraModel camera = camera_of_info(info, rectified, "input");
        require(camera.width_px > 0 && camera.height_px > 0 && camera.fx > 0, "a possible camera");
      });
    }
  });
}

}  // namespace
}  // namespace stillmap::fuzz

STILLMAP_FUZZER(stillmap::fuzz::parse)
