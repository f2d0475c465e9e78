// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stillmap/core/images.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// What a device gives at one moment.
struct DeviceImages {
  double stamp_s = 0;        ///< of the colour image, by the device's own clock
  double depth_stamp_s = 0;  ///< of the depth image, by the same clock
  ColorImage color;          ///< red, green, blue
  DepthImage depth;          ///< metres along the optical axis; 0 where it is missing
  /// What is wrong with an image that came, in one line; empty where nothing is. The images then
  /// mean nothing.
  std::string damage = {};
};

/// The driver of a depth camera. DeviceStream makes a stream of frames of it. Called by one thread
/// at a time.
class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  /// As in messages, such as "openni2:0".
  [[nodiscard]] virtual const std::string& name() const = 0;

  /// The camera as the device tells it; nothing where it does not.
  [[nodiscard]] virtual std::optional<CameraModel> camera() const = 0;

  /// The next images, which nobody was given before; of several, the newest. Waits for them at most
  /// `timeout_s`, and that long where none come, also while the device is unplugged: a later call
  /// may give images again. Throws Error for a device that will never give images again.
  [[nodiscard]] virtual std::optional<DeviceImages> wait(double timeout_s) = 0;

  /// What is wrong with it from the beginning, a line each.
  [[nodiscard]] virtual std::vector<std::string> warnings() const { return {}; }

  /// What was chosen of what it has, such as its topics; empty where there was nothing to choose.
  [[nodiscard]] virtual std::string choice() const { return {}; }

  /// Whether there will be no more images, as at the end of a file that stands for a device.
  [[nodiscard]] virtual bool ended() const { return false; }
};

}  // namespace stillmap
