// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "tooling/devices/device.hpp"

namespace stillmap {

/// Whether this build has the library of OpenNI2.
[[nodiscard]] bool has_openni();

/// Opens a depth camera by OpenNI2: `which` counts the connected ones from 0, or is the URI of one.
/// Messages call it `name`. Colour and depth have one size, the largest up to 640x480 that both
/// have, and are taken at the same time where the device can do it. `registered`: depth is
/// registered to colour by the device; warnings() says where it cannot do that. Its camera is a
/// pinhole with the field of view that the device tells. A device that is unplugged is opened again
/// when it, or another of its kind, is plugged in. Throws Error where there is no such device, for
/// one without colour or depth, and in a build without the library.
[[nodiscard]] std::unique_ptr<Device> open_openni_device(const std::string& which,
                                                         const std::string& name,
                                                         bool registered);

}  // namespace stillmap
