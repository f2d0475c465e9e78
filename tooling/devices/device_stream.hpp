// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "stillmap/sensor/clock.hpp"
#include "stillmap/sensor/depth_registration.hpp"
#include "stillmap/sensor/frame_stream.hpp"
#include "tooling/devices/device.hpp"

namespace stillmap {

struct DeviceStreamOptions {
  std::optional<CameraModel> camera;  ///< instead of the one that the device tells
  double begin_s = 0;                 ///< the stamp of the first frame, such as the time of day
  /// Whether the stream is to end. Asked several times a second, by the thread in next().
  std::function<bool()> stopped;
  /// Told in one line when images stay out, and when they come again; called by the thread in
  /// next().
  std::function<void(const std::string&)> tell;
};

/// The frames of a device. Images that stay out for kToldAfterS are told and waited for. Images of
/// the wrong size, or that the device calls damaged, are damaged frames. Stamps are those of the
/// device while its clock agrees with ours within kClockSlackS; after a device begins anew, its
/// stamps are tied to our clock again.
class DeviceStream : public FrameStream {
 public:
  /// Device and clock outlive the object. Throws Error where the camera is not known.
  DeviceStream(Device& device, Clock& clock, DeviceStreamOptions options);

  [[nodiscard]] const CameraModel& camera() const override { return camera_; }
  [[nodiscard]] std::optional<StreamedFrame> next() override;
  [[nodiscard]] std::vector<std::string> warnings() const override;

  static constexpr double kToldAfterS = 1, kClockSlackS = 0.5;

 private:
  /// The next images; nothing at the end.
  [[nodiscard]] std::optional<DeviceImages> wait_for_images();
  void note_arrival();
  /// The stream's time of images that have just arrived.
  [[nodiscard]] double stream_time_s(double device_s);
  [[nodiscard]] StreamedFrame make_streamed(DeviceImages images, double stamp_s);

  Device& device_;
  Clock& clock_;
  DeviceStreamOptions options_;
  CameraModel camera_;
  std::optional<DepthRegistration> registration_;
  std::optional<double> clock_begin_s_;  // when the first images came
  double waiting_since_s_ = 0;           // by the clock
  bool told_ = false;
  double offset_s_ = 0;  // of the stream's stamps after the device's
  std::optional<double> last_stamp_s_;
  std::uint32_t next_id_ = 0;
  std::size_t pauses_ = 0, repeated_ = 0;
  double paused_s_ = 0;
};

}  // namespace stillmap
