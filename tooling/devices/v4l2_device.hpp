// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "tooling/devices/device.hpp"
#include "tooling/devices/device_request.hpp"
#include "tooling/devices/video_system.hpp"

namespace stillmap {

/// Opens a depth camera whose driver in Linux gives colour and depth as two video nodes, as that of
/// Intel RealSense D400 does: `which` is "COLOR,DEPTH", such as "/dev/video4,/dev/video2". Messages
/// call it `name`. The sizes are those of the camera that is asked for, else the largest up to
/// 640x480 that both have. It tells no camera and registers no depth: warnings() says where a
/// camera without a depth camera of its own was asked for. Nodes that are unplugged are opened
/// again when they are back. Throws Error where there are no such nodes, and for one node alone.
/// `system` outlives the object.
[[nodiscard]] std::unique_ptr<Device> open_v4l2_device(const std::string& which,
                                                       const std::string& name,
                                                       const DeviceRequest& request,
                                                       VideoSystem& system = linux_video());

}  // namespace stillmap
