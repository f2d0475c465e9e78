// SPDX-License-Identifier: Apache-2.0
#include "tooling/devices/open_device.hpp"

#include <string_view>

#include "stillmap/core/error.hpp"
#include "tooling/devices/openni_device.hpp"
#include "tooling/devices/rosbridge_device.hpp"
#include "tooling/devices/v4l2_device.hpp"

namespace stillmap {
namespace {

// What follows the kind of a device in its text; nothing for another kind.
std::optional<std::string> after(const std::string& text, std::string_view kind) {
  if (!text.starts_with(kind)) return std::nullopt;
  return text.substr(kind.size());
}

}  // namespace

std::unique_ptr<Device> open_device(const std::string& text, const DeviceRequest& request) {
  if (const auto which = after(text, "openni2:")) {
    return open_openni_device(*which, text, request.registered());
  }
  if (const auto which = after(text, "v4l2:")) return open_v4l2_device(*which, text, request);
  if (const auto url = after(text, "stream:")) return open_rosbridge_device(*url, text, request);
  throw Error(
      "{}: unknown device, expected openni2:NUMBER, v4l2:COLOR,DEPTH or stream:ws://HOST:PORT",
      text);
}

}  // namespace stillmap
