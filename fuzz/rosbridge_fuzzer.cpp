// SPDX-License-Identifier: Apache-2.0
// Any bytes are read as a message of rosbridge, in JSON and in CBOR, or refused; what it holds is
// made an image, a camera and a list of topics, or refused.
#include "fuzz/harness.hpp"
#include "tooling/ros/camera_info.hpp"
#include "tooling/ros/rosbridge_message.hpp"

namespace stillmap::fuzz {
namespace {

void read_content(const nlohmann::json& content) {
  read_or_refuse([&] {
    const BridgedImage image(content, "input");
    (void)image.kind();
    read_or_refuse([&] { require(!image.color("input").mat.empty(), "an image has pixels"); });
    read_or_refuse(
        [&] { require(!image.depth(1000, "input").mat.empty(), "an image has pixels"); });
  });
  read_or_refuse([&] {
    const RosCameraInfo info = bridged_camera_info(content, "input");
    read_or_refuse([&] {
      const CameraModel camera = camera_of_info(info, false, "input");
      require(camera.width_px > 0 && camera.height_px > 0 && camera.fx > 0, "a possible camera");
    });
  });
  read_or_refuse([&] {
    for (const BridgeTopic& topic : bridged_topics(content, "input")) {
      const std::string asked = subscribe_message({topic.name, true, 0});
      require(read_bridge_message(asked, false, "input").topic == topic.name,
              "a subscription names the topic");
    }
  });
}

// The first byte says how the others are read.
void read(std::string_view bytes) {
  if (bytes.empty()) return;
  const bool binary = (bytes.front() & 1) != 0;
  read_or_refuse(
      [&] { read_content(read_bridge_message(bytes.substr(1), binary, "input").content); });
}

}  // namespace
}  // namespace stillmap::fuzz

STILLMAP_FUZZER(stillmap::fuzz::read)
