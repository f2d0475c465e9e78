// SPDX-License-Identifier: Apache-2.0
#include "tooling/devices/openni_device.hpp"

#include "stillmap/core/error.hpp"

#if STILLMAP_WITH_OPENNI

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <OpenNI.h>

#include "stillmap/sensor/field_of_view.hpp"
#include "tooling/devices/device_request.hpp"
#include "tooling/devices/image_pairs.hpp"
#include "tooling/devices/openni_plug.hpp"

namespace stillmap {
namespace {

// What the library says of its last failure, in one line.
std::string library_text() {
  std::string text = openni::OpenNI::getExtendedError();
  std::ranges::replace(text, '\n', ' ');
  std::ranges::replace(text, '\t', ' ');
  text.erase(0, text.find_first_not_of(' '));
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

/// The library, as long as anybody uses it.
class Library {
 public:
  Library() {
    if (openni::OpenNI::initialize() == openni::STATUS_OK) return;
    const std::string text = library_text();
    openni::OpenNI::shutdown();
    throw Error("OpenNI2 does not start: {}", text);
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library() { openni::OpenNI::shutdown(); }
};

std::vector<std::string> connected_uris() {
  openni::Array<openni::DeviceInfo> found;
  openni::OpenNI::enumerateDevices(&found);
  std::vector<std::string> uris;
  for (int i = 0; i < found.getSize(); ++i) uris.emplace_back(found[i].getUri());
  return uris;
}

// The URI of the device that is asked for.
std::string uri_of(const std::string& which, const std::string& name) {
  std::size_t index = 0;
  const auto [end, status] = std::from_chars(which.data(), which.data() + which.size(), index);
  if (which.empty()) throw Error("{}: expected openni2:NUMBER or openni2:URI", name);
  if (status != std::errc() || end != which.data() + which.size()) return which;
  const std::vector<std::string> uris = connected_uris();
  if (index < uris.size()) return uris[index];
  std::string listed;
  for (const std::string& uri : uris) listed += " " + uri;
  throw Error("{}: OpenNI2 finds {} cameras{}; is it plugged in, and may this user open it?",
              name,
              uris.size(),
              listed.empty() ? "" : ":" + listed);
}

bool is_depth(const openni::VideoMode& mode) {
  return mode.getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_1_MM ||
         mode.getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_100_UM;
}
bool is_color(const openni::VideoMode& mode) {
  return mode.getPixelFormat() == openni::PIXEL_FORMAT_RGB888;
}

using ModePair = std::pair<openni::VideoMode, openni::VideoMode>;  // colour, depth

// The largest size up to 640x480 that both have, at the highest rate; depth in millimetres first.
ModePair choose_modes(openni::Device& device, const std::string& name) {
  const openni::SensorInfo* color = device.getSensorInfo(openni::SENSOR_COLOR);
  const openni::SensorInfo* depth = device.getSensorInfo(openni::SENSOR_DEPTH);
  if (color == nullptr || depth == nullptr) {
    throw Error("{}: has no {}; expected a camera of colour and depth",
                name,
                color == nullptr ? "colour" : "depth");
  }
  const auto& colors = color->getSupportedVideoModes();
  const auto& depths = depth->getSupportedVideoModes();
  std::optional<ModePair> best;
  std::array<int, 3> best_rank{};
  for (int i = 0; i < colors.getSize(); ++i) {
    for (int j = 0; j < depths.getSize(); ++j) {
      const openni::VideoMode &c = colors[i], &d = depths[j];
      const bool fits = is_color(c) && is_depth(d) && c.getResolutionX() == d.getResolutionX() &&
                        c.getResolutionY() == d.getResolutionY() && c.getResolutionX() <= 640;
      if (!fits) continue;
      const bool in_mm = d.getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_1_MM;
      const std::array<int, 3> rank = {
          c.getResolutionX() * c.getResolutionY(), std::min(c.getFps(), d.getFps()), in_mm};
      if (best && rank <= best_rank) continue;
      best = {c, d};
      best_rank = rank;
    }
  }
  if (!best) {
    throw Error("{}: has no mode in which colour (RGB888) and depth have one size", name);
  }
  return *best;
}

// The pixels of a frame, copied.
template <class Pixel>
cv::Mat_<Pixel> pixels_of(const openni::VideoFrameRef& frame) {
  cv::Mat_<Pixel> pixels(frame.getHeight(), frame.getWidth());
  const auto* row = static_cast<const std::byte*>(frame.getData());
  for (int v = 0; v < pixels.rows; ++v, row += frame.getStrideInBytes()) {
    std::memcpy(pixels.ptr(v), row, sizeof(Pixel) * static_cast<std::size_t>(pixels.cols));
  }
  return pixels;
}

double seconds_of(const openni::VideoFrameRef& frame) {
  return 1e-6 * static_cast<double>(frame.getTimestamp());
}

class OpenNiDevice : public Device {
 public:
  OpenNiDevice(const std::string& which, std::string name, bool registered)
      : name_(std::move(name)), registered_(registered), plug_(uri_of(which, name_)) {
    open();
  }
  ~OpenNiDevice() override { close(); }

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] std::optional<CameraModel> camera() const override { return camera_; }
  [[nodiscard]] std::optional<DeviceImages> wait(double timeout_s) override;
  [[nodiscard]] std::vector<std::string> warnings() const override { return warnings_; }

 private:
  void open();
  void start(openni::VideoStream& stream, openni::SensorType sensor, openni::VideoMode mode);
  void register_depth();
  void read_camera(const openni::VideoMode& mode);
  void close();
  [[nodiscard]] bool open_again(SteadyTime until);
  /// Reads one image of either kind; returns whether there was one.
  [[nodiscard]] bool read_one(SteadyTime until);
  [[nodiscard]] DeviceImages images_of(const openni::VideoFrameRef& color,
                                       const openni::VideoFrameRef& depth) const;

  Library library_;  // first member: the others use it
  std::string name_;
  bool registered_;  // as asked for
  Plug plug_;
  openni::Device device_;
  openni::VideoStream color_stream_, depth_stream_;
  ImagePairs<openni::VideoFrameRef, openni::VideoFrameRef> pairs_;
  std::optional<CameraModel> camera_;
  double depth_factor_ = 1000;
  double same_time_s_ = 0;  // greatest difference between the stamps of images of one moment
  std::vector<std::string> warnings_;
  bool opened_ = false;
};

void OpenNiDevice::open() {
  if (device_.open(plug_.uri().c_str()) != openni::STATUS_OK) {
    throw Error("{}: cannot be opened ({})", name_, library_text());
  }
  const auto [color, depth] = choose_modes(device_, name_);
  start(color_stream_, openni::SENSOR_COLOR, color);
  start(depth_stream_, openni::SENSOR_DEPTH, depth);
  register_depth();
  device_.setDepthColorSyncEnabled(true);  // where it can; images are paired by stamps anyway
  depth_factor_ = depth.getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_1_MM ? 1000 : 10000;
  same_time_s_ = 0.6 / std::max(1, std::min(color.getFps(), depth.getFps()));
  read_camera(color);
  opened_ = true;
}

bool same_mode(const openni::VideoMode& a, const openni::VideoMode& b) {
  return a.getResolutionX() == b.getResolutionX() && a.getResolutionY() == b.getResolutionY() &&
         a.getFps() == b.getFps() && a.getPixelFormat() == b.getPixelFormat();
}

void OpenNiDevice::start(openni::VideoStream& stream,
                         openni::SensorType sensor,
                         openni::VideoMode mode) {
  bool good =
      stream.create(device_, sensor) == openni::STATUS_OK &&
      (same_mode(stream.getVideoMode(), mode) || stream.setVideoMode(mode) == openni::STATUS_OK);
  if (good) {
    stream.setMirroringEnabled(false);  // fails where it is never mirrored
    good = stream.start() == openni::STATUS_OK;
  }
  if (!good) {
    throw Error("{}: {} does not start ({})",
                name_,
                sensor == openni::SENSOR_COLOR ? "colour" : "depth",
                library_text());
  }
}

void OpenNiDevice::register_depth() {
  const auto mode =
      registered_ ? openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR : openni::IMAGE_REGISTRATION_OFF;
  const bool done = device_.isImageRegistrationModeSupported(mode) &&
                    device_.setImageRegistrationMode(mode) == openni::STATUS_OK;
  warnings_.clear();
  if (done || !registered_) return;
  warnings_.push_back(not_registered(name_));
}

void OpenNiDevice::read_camera(const openni::VideoMode& mode) {
  const double across = static_cast<double>(color_stream_.getHorizontalFieldOfView());
  const double down = static_cast<double>(color_stream_.getVerticalFieldOfView());
  camera_.reset();
  if (!(across > 0) || !(down > 0)) return;
  CameraModel camera =
      pinhole_of_view({mode.getResolutionX(), mode.getResolutionY()}, across, down);
  camera.name = name_;
  camera.depth_factor = depth_factor_;
  camera_ = camera;
}

void OpenNiDevice::close() {
  pairs_.clear();
  color_stream_.stop();
  depth_stream_.stop();
  // Threads of some drivers, such as that of "Dummy", use a stream for some time after stop().
  if (opened_) plug_.wait_for_change(SteadyTime::clock::now() + std::chrono::milliseconds(100));
  color_stream_.destroy();
  depth_stream_.destroy();
  device_.close();
  opened_ = false;
}

bool OpenNiDevice::open_again(SteadyTime until) {
  close();
  if (!plug_.wait_until(until)) return false;
  try {
    open();
    return true;
  } catch (const Error&) {  // it may need a moment: the next call tries again
    close();
    return false;
  }
}

bool OpenNiDevice::read_one(SteadyTime until) {
  using std::chrono::milliseconds;
  const auto left = std::chrono::duration_cast<milliseconds>(until - SteadyTime::clock::now());
  if (left.count() <= 0) return false;
  std::array<openni::VideoStream*, 2> streams = {&color_stream_, &depth_stream_};
  int ready = -1;
  const openni::Status waited =
      openni::OpenNI::waitForAnyStream(streams.data(), 2, &ready, static_cast<int>(left.count()));
  if (waited != openni::STATUS_OK) return false;
  openni::VideoFrameRef frame;
  if (streams[static_cast<std::size_t>(ready)]->readFrame(&frame) != openni::STATUS_OK)
    return false;
  if (ready == 0) {
    pairs_.add_color(seconds_of(frame), frame);
  } else {
    pairs_.add_depth(seconds_of(frame), frame);
  }
  return true;
}

DeviceImages OpenNiDevice::images_of(const openni::VideoFrameRef& color,
                                     const openni::VideoFrameRef& depth) const {
  DeviceImages images;
  images.stamp_s = seconds_of(color);
  images.depth_stamp_s = seconds_of(depth);
  images.color = ColorImage(pixels_of<cv::Vec3b>(color));
  const cv::Mat1w units = pixels_of<std::uint16_t>(depth);
  cv::Mat1f metres(units.size());
  const float factor = static_cast<float>(depth_factor_);
  std::transform(units.begin(), units.end(), metres.begin(), [factor](std::uint16_t unit) {
    return static_cast<float>(unit) / factor;
  });
  images.depth = DepthImage(metres);
  return images;
}

std::optional<DeviceImages> OpenNiDevice::wait(double timeout_s) {
  const auto timeout = std::chrono::duration<double>(timeout_s);
  const SteadyTime until =
      SteadyTime::clock::now() + std::chrono::duration_cast<SteadyTime::duration>(timeout);
  const bool open = (opened_ && plug_.plugged_in()) || open_again(until);
  while (open && read_one(until)) {
    const auto pair = pairs_.take(same_time_s_);
    if (pair) return images_of(pair->first.image, pair->second.image);
  }
  plug_.wait_for_change(until);  // a device that fails at once is not asked all the time
  return std::nullopt;
}

}  // namespace

bool has_openni() {
  return true;
}

std::unique_ptr<Device> open_openni_device(const std::string& which,
                                           const std::string& name,
                                           bool registered) {
  return std::make_unique<OpenNiDevice>(which, name, registered);
}

}  // namespace stillmap

#else

namespace stillmap {

bool has_openni() {
  return false;
}

std::unique_ptr<Device> open_openni_device(const std::string& /*which*/,
                                           const std::string& name,
                                           bool /*registered*/) {
  throw Error("{}: this build has no OpenNI2; install libopenni2-dev and configure and build again",
              name);
}

}  // namespace stillmap

#endif
