// SPDX-License-Identifier: Apache-2.0
#include "tooling/devices/device_stream.hpp"

#include <cmath>
#include <memory>
#include <utility>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/sensor/stamps.hpp"

namespace stillmap {
namespace {

constexpr double kWaitS = 0.25;

// What is wrong with the size of an image; empty where it is as expected.
std::string size_problem(const cv::Mat& image, const CameraModel& camera, const char* what) {
  if (image.cols == camera.width_px && image.rows == camera.height_px) return {};
  return fmt::format("{} of {}x{} pixels, expected {}x{}",
                     what,
                     image.cols,
                     image.rows,
                     camera.width_px,
                     camera.height_px);
}

CameraModel chosen_camera(const Device& device, const std::optional<CameraModel>& named) {
  if (named) return *named;
  std::optional<CameraModel> told = device.camera();
  if (!told) throw Error("{} does not tell its camera: name it with --camera", device.name());
  return *std::move(told);
}

}  // namespace

DeviceStream::DeviceStream(Device& device, Clock& clock, DeviceStreamOptions options)
    : device_(device),
      clock_(clock),
      options_(std::move(options)),
      camera_(chosen_camera(device, options_.camera)) {
  check_camera(camera_, "camera '" + camera_.name + "'");
  if (camera_.depth_camera) registration_.emplace(camera_);
}

std::optional<DeviceImages> DeviceStream::wait_for_images() {
  waiting_since_s_ = clock_.now_s();
  told_ = false;
  while (!options_.stopped()) {
    std::optional<DeviceImages> images = device_.wait(kWaitS);
    if (images) {
      note_arrival();
      return images;
    }
    if (device_.ended()) return std::nullopt;
    if (!told_ && clock_.now_s() - waiting_since_s_ >= kToldAfterS) {
      told_ = true;
      options_.tell(
          fmt::format("{} gives no images; waiting for it (Ctrl-C ends the run)", device_.name()));
    }
  }
  return std::nullopt;
}

void DeviceStream::note_arrival() {
  if (!told_) return;
  const double waited_s = clock_.now_s() - waiting_since_s_;
  ++pauses_;
  paused_s_ += waited_s;
  options_.tell(fmt::format("{} gives images again, after {:.1f} s", device_.name(), waited_s));
}

double DeviceStream::stream_time_s(double device_s) {
  const double now_s = clock_.now_s();
  if (!clock_begin_s_) {
    clock_begin_s_ = now_s;
    offset_s_ = options_.begin_s - device_s;
  }
  const double by_clock_s = options_.begin_s + now_s - *clock_begin_s_;
  if (std::abs(device_s + offset_s_ - by_clock_s) > kClockSlackS) {
    offset_s_ = by_clock_s - device_s;
  }
  return device_s + offset_s_;
}

StreamedFrame DeviceStream::make_streamed(DeviceImages images, double stamp_s) {
  const FrameId id(next_id_++);
  const Stamp stamp = stamp_of_seconds(stamp_s);
  const CameraModel& depth_camera = registration_ ? camera_.depth_camera->camera : camera_;
  std::string problem = images.damage;
  if (problem.empty()) problem = size_problem(images.color.mat, camera_, "colour");
  if (problem.empty()) problem = size_problem(images.depth.mat, depth_camera, "depth");
  if (!problem.empty()) return DamagedFrame{id, stamp, device_.name() + ": " + problem};
  if (registration_) images.depth = registration_->to_color(images.depth);
  RgbdFrame frame = make_frame(stamp_s, std::move(images.color), std::move(images.depth));
  frame.id = id;
  frame.stamp = stamp;
  frame.depth_stamp_s = images.depth_stamp_s + offset_s_;
  return std::make_shared<const RgbdFrame>(std::move(frame));
}

std::optional<StreamedFrame> DeviceStream::next() {
  while (std::optional<DeviceImages> images = wait_for_images()) {
    const double stamp_s = stream_time_s(images->stamp_s);
    // Texts of stamps have microseconds.
    if (last_stamp_s_ && stamp_s < *last_stamp_s_ + 1e-6) {
      ++repeated_;
      continue;
    }
    last_stamp_s_ = stamp_s;
    return make_streamed(*std::move(images), stamp_s);
  }
  return std::nullopt;
}

std::vector<std::string> DeviceStream::warnings() const {
  std::vector<std::string> lines;
  if (pauses_ > 0) {
    lines.push_back(fmt::format(
        "{} gave no images {} times, for {:.1f} s in all", device_.name(), pauses_, paused_s_));
  }
  if (repeated_ > 0) {
    lines.push_back(fmt::format(
        "{}: {} images repeat the stamp of others and are left out", device_.name(), repeated_));
  }
  return lines;
}

}  // namespace stillmap
