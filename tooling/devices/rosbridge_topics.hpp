// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tooling/devices/device_request.hpp"
#include "tooling/devices/web_socket.hpp"

namespace stillmap {

/// The topics of a robot that a run takes, and what their CameraInfos say.
struct RosbridgeTopics {
  std::string color, depth;
  std::optional<CameraModel> camera;  ///< that of the colour images, where nobody named another
  std::vector<std::string> warnings;
};

/// Finds them over a connection that is open: those that the request names, else by what the images
/// of each topic show, with the rule for bags (ros_topics.hpp). One image of each topic is asked
/// for. Throws Error, beginning with `name`, where they are not known, where no CameraInfo tells
/// the camera and nobody named it, and for depth of another size than colour that no depth camera
/// registers.
[[nodiscard]] RosbridgeTopics find_rosbridge_topics(WebSocketClient& socket,
                                                    const std::string& name,
                                                    const DeviceRequest& request);

}  // namespace stillmap
