// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// How a server of rosbridge sends a message.
enum class BridgeCoding { kJson, kCbor };

inline std::string to_base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      bits = bits * 256 + (at + i < bytes.size() ? static_cast<std::uint8_t>(bytes[at + i]) : 0U);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const bool padding = at + i > bytes.size();
      text += padding ? '='
                      : kDigits[bits /
                                (i == 0   ? 262144U
                                 : i == 1 ? 4096U
                                 : i == 2 ? 64U
                                          : 1U) %
                                64U];
    }
  }
  return text;
}

inline nlohmann::json bytes_value(std::string_view bytes, BridgeCoding coding) {
  if (coding == BridgeCoding::kJson) return to_base64(bytes);
  return nlohmann::json::binary({bytes.begin(), bytes.end()});
}

inline nlohmann::json header_value(std::uint64_t stamp_ns) {
  return {{"seq", 1},
          {"stamp", {{"secs", stamp_ns / 1000000000U}, {"nsecs", stamp_ns % 1000000000U}}},
          {"frame_id", "camera"}};
}

/// The content of a sensor_msgs/Image.
inline nlohmann::json image_value(const cv::Mat& pixels,
                                  const std::string& encoding,
                                  std::uint64_t stamp_ns,
                                  BridgeCoding coding) {
  const std::string_view bytes(reinterpret_cast<const char*>(pixels.data),
                               pixels.total() * pixels.elemSize());
  return {{"header", header_value(stamp_ns)},
          {"height", pixels.rows},
          {"width", pixels.cols},
          {"encoding", encoding},
          {"is_bigendian", 0},
          {"step", static_cast<std::size_t>(pixels.cols) * pixels.elemSize()},
          {"data", bytes_value(bytes, coding)}};
}

/// The content of a sensor_msgs/CameraInfo without distortion.
inline nlohmann::json info_value(const CameraModel& camera) {
  return {{"header", header_value(0)},
          {"height", camera.height_px},
          {"width", camera.width_px},
          {"distortion_model", "plumb_bob"},
          {"D", {0, 0, 0, 0, 0}},
          {"K", {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1}},
          {"R", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
          {"P", {camera.fx, 0, camera.cx, 0, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0}}};
}

/// The bytes of a message; CBOR by the encoder of nlohmann-json.
inline std::string encoded(const nlohmann::json& message, BridgeCoding coding) {
  if (coding == BridgeCoding::kJson) return message.dump();
  const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(message);
  return {bytes.begin(), bytes.end()};
}

inline nlohmann::json published(const std::string& topic, nlohmann::json content) {
  return {{"op", "publish"}, {"topic", topic}, {"msg", std::move(content)}};
}

}  // namespace stillmap
