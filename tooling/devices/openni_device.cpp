// SPDX-License-Identifier: Apache-2.0
#include "tooling/devices/openni_device.hpp"

#include "stillmap/core/error.hpp"

#if STILLMAP_WITH_OPENNI

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include <OpenNI.h>

namespace stillmap {
namespace {

using SteadyTime = std::chrono::steady_clock::time_point;

// What the library says of its last failure, in one line.
std::string library_text() {
  std::string text = openni::OpenNI::getExtendedError();
  std::ranges::replace(text, '\n', ' ');
  std::ranges::replace(text, '\t', ' ');
  text.erase(0, text.find_first_not_of(' '));
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

// May be called several times. The library is never shut down: a driver that Debian ships with it
// crashes then, and devices are closed one by one.
void start_library() {
  if (openni::OpenNI::initialize() == openni::STATUS_OK) return;
  throw Error("OpenNI2 does not start: {}", library_text());
}

std::vector<std::string> connected_uris() {
  openni::Array<openni::DeviceInfo> found;
  openni::OpenNI::enumerateDevices(&found);
  std::vector<std::string> uris;
  for (int i = 0; i < found.getSize(); ++i) uris.emplace_back(found[i].getUri());
  return uris;
}

// The URI of the device that is asked for. Starts the library.
std::string uri_of(const std::string& which, const std::string& name) {
  std::size_t index = 0;
  start_library();
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

// "1d27/0601@1/5": what it is, without where it is plugged in.
std::string_view kind_of(std::string_view uri) {
  return uri.substr(0, uri.find('@'));
}

/// Notes when a device is plugged in or out. The library calls it on threads of its own.
class Plug : public openni::OpenNI::DeviceConnectedListener,
             public openni::OpenNI::DeviceDisconnectedListener {
 public:
  explicit Plug(std::string uri) : uri_(std::move(uri)) {
    openni::OpenNI::addDeviceConnectedListener(this);
    openni::OpenNI::addDeviceDisconnectedListener(this);
  }
  Plug(const Plug&) = delete;
  Plug& operator=(const Plug&) = delete;
  ~Plug() {
    openni::OpenNI::removeDeviceConnectedListener(this);
    openni::OpenNI::removeDeviceDisconnectedListener(this);
  }

  [[nodiscard]] std::string uri() const {
    const std::lock_guard lock(mutex_);
    return uri_;
  }
  [[nodiscard]] bool plugged_in() const {
    const std::lock_guard lock(mutex_);
    return plugged_in_;
  }
  /// Returns whether it is plugged in by then.
  [[nodiscard]] bool wait_until(SteadyTime time) {
    std::unique_lock lock(mutex_);
    return changed_.wait_until(lock, time, [&] { return plugged_in_; });
  }
  /// Returns when it is plugged in or out, or at that time.
  void wait_for_change(SteadyTime time) {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, time, [this, before = plugged_in_] { return plugged_in_ != before; });
  }

 private:
  void onDeviceConnected(const openni::DeviceInfo* device) override {
    const std::lock_guard lock(mutex_);
    if (plugged_in_ || kind_of(device->getUri()) != kind_of(uri_)) return;
    uri_ = device->getUri();
    plugged_in_ = true;
    changed_.notify_all();
  }
  void onDeviceDisconnected(const openni::DeviceInfo* device) override {
    const std::lock_guard lock(mutex_);
    if (uri_ != device->getUri()) return;
    plugged_in_ = false;
    changed_.notify_all();
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::string uri_;
  bool plugged_in_ = true;
};

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
    std::memcpy(pixels[v], row, sizeof(Pixel) * static_cast<std::size_t>(pixels.cols));
  }
  return pixels;
}

double seconds_of(const openni::VideoFrameRef& frame) {
  return 1e-6 * static_cast<double>(frame.getTimestamp());
}

class OpenNiDevice : public Device {
 public:
  OpenNiDevice(const std::string& which, std::string name)
      : name_(std::move(name)), plug_(uri_of(which, name_)) {
    open();
  }
  ~OpenNiDevice() override { close(); }

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] std::optional<CameraModel> camera() const override { return camera_; }
  [[nodiscard]] std::optional<DeviceImages> wait(double timeout_s) override;

 private:
  void open();
  void start(openni::VideoStream& stream, openni::SensorType sensor, openni::VideoMode mode);
  void read_camera(const openni::VideoMode& mode);
  void close();
  [[nodiscard]] bool open_again(SteadyTime until);
  /// Reads one image of either kind; returns whether there was one.
  [[nodiscard]] bool read_one(SteadyTime until);
  /// The newest pair of one moment; it and what is older goes.
  [[nodiscard]] std::optional<DeviceImages> take_pair();
  [[nodiscard]] DeviceImages images_of(const openni::VideoFrameRef& color,
                                       const openni::VideoFrameRef& depth) const;

  std::string name_;
  Plug plug_;
  openni::Device device_;
  openni::VideoStream color_stream_, depth_stream_;
  // Images that have no partner yet, the oldest first. Colour may come some frames after the depth
  // of its moment.
  std::deque<openni::VideoFrameRef> color_, depth_;
  std::optional<CameraModel> camera_;
  double depth_factor_ = 1000;
  double same_time_s_ = 0;  // greatest difference between the stamps of images of one moment
  bool opened_ = false;
};

void OpenNiDevice::open() {
  if (device_.open(plug_.uri().c_str()) != openni::STATUS_OK) {
    throw Error("{}: cannot be opened ({})", name_, library_text());
  }
  const auto [color, depth] = choose_modes(device_, name_);
  start(color_stream_, openni::SENSOR_COLOR, color);
  start(depth_stream_, openni::SENSOR_DEPTH, depth);
  const auto registered = openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
  if (device_.isImageRegistrationModeSupported(registered)) {
    device_.setImageRegistrationMode(registered);
  }
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

void OpenNiDevice::read_camera(const openni::VideoMode& mode) {
  const double across = static_cast<double>(color_stream_.getHorizontalFieldOfView());
  const double down = static_cast<double>(color_stream_.getVerticalFieldOfView());
  camera_.reset();
  if (!(across > 0) || !(down > 0)) return;
  CameraModel camera;
  camera.name = name_;
  camera.width_px = mode.getResolutionX();
  camera.height_px = mode.getResolutionY();
  camera.fx = 0.5 * camera.width_px / std::tan(0.5 * across);
  camera.fy = 0.5 * camera.height_px / std::tan(0.5 * down);
  camera.cx = 0.5 * (camera.width_px - 1);
  camera.cy = 0.5 * (camera.height_px - 1);
  camera.depth_factor = depth_factor_;
  camera_ = camera;
}

void OpenNiDevice::close() {
  color_.clear();
  depth_.clear();
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
  constexpr std::size_t kMostWaiting = 4;
  std::deque<openni::VideoFrameRef>& waiting = ready == 0 ? color_ : depth_;
  waiting.push_back(frame);
  if (waiting.size() > kMostWaiting) waiting.pop_front();
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

std::optional<DeviceImages> OpenNiDevice::take_pair() {
  for (std::size_t i = color_.size(); i-- > 0;) {
    for (std::size_t j = depth_.size(); j-- > 0;) {
      if (std::abs(seconds_of(color_[i]) - seconds_of(depth_[j])) > same_time_s_) continue;
      DeviceImages images = images_of(color_[i], depth_[j]);
      color_.erase(color_.begin(), color_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      depth_.erase(depth_.begin(), depth_.begin() + static_cast<std::ptrdiff_t>(j) + 1);
      return images;
    }
  }
  return std::nullopt;
}

std::optional<DeviceImages> OpenNiDevice::wait(double timeout_s) {
  const auto timeout = std::chrono::duration<double>(timeout_s);
  const SteadyTime until =
      SteadyTime::clock::now() + std::chrono::duration_cast<SteadyTime::duration>(timeout);
  const bool open = (opened_ && plug_.plugged_in()) || open_again(until);
  while (open && read_one(until)) {
    std::optional<DeviceImages> images = take_pair();
    if (images) return images;
  }
  plug_.wait_for_change(until);  // a device that fails at once is not asked all the time
  return std::nullopt;
}

}  // namespace

bool has_openni() {
  return true;
}

std::unique_ptr<Device> open_openni_device(const std::string& which, const std::string& name) {
  return std::make_unique<OpenNiDevice>(which, name);
}

}  // namespace stillmap

#else

namespace stillmap {

bool has_openni() {
  return false;
}

std::unique_ptr<Device> open_openni_device(const std::string& /*which*/, const std::string& name) {
  throw Error("{}: this build has no OpenNI2; install libopenni2-dev and configure and build again",
              name);
}

}  // namespace stillmap

#endif
