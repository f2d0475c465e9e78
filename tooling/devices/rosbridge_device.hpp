// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "tooling/devices/device.hpp"
#include "tooling/devices/device_request.hpp"

namespace stillmap {

/// Whether this build has the library of WebSockets.
[[nodiscard]] bool has_streams();

/// Opens the colour and depth images of a robot with ROS 1 or ROS 2, which come over the network by
/// rosbridge's protocol: `url` is "ws://HOST:PORT/PATH". Messages call it `name`. Topics that the
/// request does not name are found as in bags, by asking the robot (rosapi); its camera is that of
/// the CameraInfo of the colour topic. A connection that is lost is tried again once a second.
/// Throws Error where it cannot be connected to, where the topics are not known, and in a build
/// without the library.
[[nodiscard]] std::unique_ptr<Device> open_rosbridge_device(const std::string& url,
                                                            const std::string& name,
                                                            const DeviceRequest& request);

}  // namespace stillmap
