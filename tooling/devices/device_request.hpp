// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <fmt/core.h>

#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// What a run asks of a device.
struct DeviceRequest {
  std::optional<CameraModel> camera = {};  ///< named by the user; comes before the device's own
  std::string color_topic = {};            ///< of a stream; empty: to be found
  std::string depth_topic = {};            ///< of a stream; empty: to be found

  /// Whether depth is to be registered to colour: the camera has no depth camera of its own.
  [[nodiscard]] bool registered() const { return !camera || !camera->depth_camera; }

  /// The units of 16-bit depth in a metre: those of the camera, where it says them, else
  /// millimetres.
  [[nodiscard]] double depth_factor() const {
    constexpr double kMillimetres = 1000;
    return camera && camera->depth_factor_given ? camera->depth_factor : kMillimetres;
  }
};

/// The warning of a device that gives depth as its depth camera sees it.
[[nodiscard]] inline std::string not_registered(const std::string& device) {
  return fmt::format(
      "{} does not register its depth to colour; name a camera with a depth camera of its own "
      "(--camera), or the map will be smeared",
      device);
}

}  // namespace stillmap
