// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "tooling/devices/device.hpp"

namespace stillmap {

/// Opens the device that a text names: "openni2:0", the first camera that OpenNI2 finds, or
/// "openni2:URI". `registered`: the device is to register its depth images to the colour images, as
/// the camera has no depth camera of its own. Throws Error, beginning with the text, for another
/// text, and as open_openni_device() does.
[[nodiscard]] std::unique_ptr<Device> open_device(const std::string& text, bool registered);

}  // namespace stillmap
