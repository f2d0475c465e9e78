// SPDX-License-Identifier: Apache-2.0
#include "tooling/devices/open_device.hpp"

#include <string_view>

#include "stillmap/core/error.hpp"
#include "tooling/devices/openni_device.hpp"

namespace stillmap {

std::unique_ptr<Device> open_device(const std::string& text, bool registered) {
  constexpr std::string_view kOpenNi = "openni2:";
  if (text.starts_with(kOpenNi)) {
    return open_openni_device(text.substr(kOpenNi.size()), text, registered);
  }
  throw Error("{}: unknown device, expected openni2:NUMBER or openni2:URI", text);
}

}  // namespace stillmap
