// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "tooling/devices/device.hpp"
#include "tooling/devices/device_request.hpp"

namespace stillmap {

/// Opens the device that a text names: "openni2:0" or "openni2:URI" (openni_device.hpp),
/// "v4l2:COLOR,DEPTH" (v4l2_device.hpp), "stream:ws://HOST:PORT" (rosbridge_device.hpp). Throws
/// Error, beginning with the text, for another text, and as opening these does.
[[nodiscard]] std::unique_ptr<Device> open_device(const std::string& text,
                                                  const DeviceRequest& request);

}  // namespace stillmap
