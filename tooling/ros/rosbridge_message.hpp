// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "stillmap/core/images.hpp"
#include "tooling/ros/ros_image.hpp"
#include "tooling/ros/ros_message.hpp"

namespace stillmap {

// Messages of the rosbridge protocol, version 2, by which programs without ROS speak with ROS 1 and
// ROS 2. Readers throw DamagedImage, beginning with `place`, for messages that are no JSON or CBOR,
// or that lack something; the memory they take is in proportion to the message.

/// A message of the server.
struct BridgeMessage {
  std::string op;          ///< such as "publish", "service_response"
  std::string topic;       ///< of "publish"
  std::string id;          ///< of the question that is answered
  bool result = false;     ///< of "service_response": whether the service was there
  nlohmann::json content;  ///< what was published, or the service's values
};
[[nodiscard]] BridgeMessage read_bridge_message(std::string_view bytes,
                                                bool binary,
                                                const std::string& place);

/// A sensor_msgs/Image or CompressedImage that owns its bytes.
class BridgedImage {
 public:
  /// Reads the content of a message: its bytes as CBOR has them, or in base64.
  BridgedImage(nlohmann::json content, const std::string& place);

  [[nodiscard]] RosImageType type() const { return type_; }
  [[nodiscard]] const RosTime& stamp() const { return stamp_; }
  /// As those of bags, ros_image.hpp.
  /// @{
  [[nodiscard]] RosImageKind kind() const;
  [[nodiscard]] ColorImage color(const std::string& place) const;
  [[nodiscard]] DepthImage depth(double depth_factor, const std::string& place) const;
  /// @}

 private:
  [[nodiscard]] RosImage plain() const;
  [[nodiscard]] RosCompressedImage compressed() const;

  RosImageType type_ = RosImageType::kPlain;
  RosTime stamp_;
  std::uint32_t height_px_ = 0, width_px_ = 0, row_bytes_ = 0;
  bool big_endian_ = false;
  std::string encoding_;  // or the format of a compressed image
  std::vector<std::uint8_t> bytes_;
};

/// The content of a sensor_msgs/CameraInfo, of ROS 1 (K, D, P) or ROS 2 (k, d, p).
[[nodiscard]] RosCameraInfo bridged_camera_info(const nlohmann::json& content,
                                                const std::string& place);

/// A topic of the robot.
struct BridgeTopic {
  std::string name;
  std::string type;  ///< in the way of ROS 1, such as "sensor_msgs/Image"
};
/// The values of a response of /rosapi/topics.
[[nodiscard]] std::vector<BridgeTopic> bridged_topics(const nlohmann::json& values,
                                                      const std::string& place);

/// How the messages of a topic are to come.
struct BridgeSubscription {
  std::string topic;
  bool cbor = false;    ///< in CBOR, not in JSON
  int throttle_ms = 0;  ///< least time between two
};
/// A message that asks for a topic; of several that wait, the server keeps the newest.
[[nodiscard]] std::string subscribe_message(const BridgeSubscription& subscription);
[[nodiscard]] std::string unsubscribe_message(const std::string& topic);
/// A message that calls a service without arguments.
[[nodiscard]] std::string call_message(const std::string& service, const std::string& id);

}  // namespace stillmap
