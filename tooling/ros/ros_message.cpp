// SPDX-License-Identifier: Apache-2.0
#include "tooling/ros/ros_message.hpp"

#include <bit>
#include <cstring>

#include "stillmap/io/image_io.hpp"

namespace stillmap {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are little-endian");

// Reads the fields of a message one after the other.
class Fields {
 public:
  Fields(std::string_view message, const std::string& place) : rest_(message), place_(place) {}

  template <class Number>
  [[nodiscard]] Number number() {
    Number value{};
    std::memcpy(&value, bytes(sizeof(Number)).data(), sizeof(Number));
    return value;
  }
  // A string or an array of bytes, with its size before it.
  [[nodiscard]] std::string_view text() { return bytes(number<std::uint32_t>()); }
  [[nodiscard]] RosTime header() {
    (void)number<std::uint32_t>();  // a counter
    RosTime stamp;
    stamp.seconds = number<std::uint32_t>();
    stamp.nanoseconds = number<std::uint32_t>();
    (void)text();  // the name of the coordinate frame
    return stamp;
  }

 private:
  [[nodiscard]] std::string_view bytes(std::size_t count) {
    if (count > rest_.size()) {
      throw DamagedImage(
          "{}: a message ends too early, expected {} bytes more", place_, count - rest_.size());
    }
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }

  std::string_view rest_;
  const std::string& place_;
};

}  // namespace

RosTime parse_ros_stamp(std::string_view message, const std::string& place) {
  return Fields(message, place).header();
}

RosImage parse_ros_image(std::string_view message, const std::string& place) {
  Fields fields(message, place);
  RosImage image;
  image.stamp = fields.header();
  image.height_px = fields.number<std::uint32_t>();
  image.width_px = fields.number<std::uint32_t>();
  image.encoding = fields.text();
  image.big_endian = fields.number<std::uint8_t>() != 0;
  image.row_bytes = fields.number<std::uint32_t>();
  image.pixels = fields.text();
  return image;
}

RosCompressedImage parse_ros_compressed_image(std::string_view message, const std::string& place) {
  Fields fields(message, place);
  RosCompressedImage image;
  image.stamp = fields.header();
  image.format = fields.text();
  image.file = fields.text();
  return image;
}

RosCameraInfo parse_ros_camera_info(std::string_view message, const std::string& place) {
  constexpr std::uint32_t kMaxDistortion = 32;
  Fields fields(message, place);
  RosCameraInfo info;
  (void)fields.header();
  info.height_px = fields.number<std::uint32_t>();
  info.width_px = fields.number<std::uint32_t>();
  info.distortion_model = std::string(fields.text());
  const std::uint32_t count = fields.number<std::uint32_t>();
  if (count > kMaxDistortion) throw DamagedImage("{}: {} parameters of distortion", place, count);
  for (std::uint32_t i = 0; i < count; ++i) info.distortion.push_back(fields.number<double>());
  for (double& number : info.intrinsics) number = fields.number<double>();
  for (int i = 0; i < 9; ++i) (void)fields.number<double>();  // the rotation of a stereo pair
  for (double& number : info.projection) number = fields.number<double>();
  return info;
}

float parse_ros_float(std::string_view message, const std::string& place) {
  return Fields(message, place).number<float>();
}

}  // namespace stillmap
