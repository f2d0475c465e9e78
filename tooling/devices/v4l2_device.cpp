// SPDX-License-Identifier: Apache-2.0
#include "tooling/devices/v4l2_device.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/geometry/camera.hpp"
#include "tooling/devices/image_pairs.hpp"
#include "tooling/devices/video_node.hpp"

namespace stillmap {
namespace {

using VideoTime = std::chrono::steady_clock::time_point;

int milliseconds_until(VideoTime until) {
  const auto left =
      std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
  return static_cast<int>(std::max<std::int64_t>(0, left.count()));
}

cv::Size size_of(const CameraModel& camera) {
  return {camera.width_px, camera.height_px};
}

WantedSizes sizes_of(const DeviceRequest& request) {
  if (!request.camera) return {};
  const CameraModel& color = *request.camera;
  return {size_of(color), size_of(color.depth_camera ? color.depth_camera->camera : color)};
}

// The error of one node, which says what is missing.
[[noreturn]] void refuse_alone(VideoSystem& system,
                               const std::string& path,
                               const std::string& name) {
  if (path.empty()) throw Error("{}: expected v4l2:COLOR,DEPTH, two video nodes", name);
  const VideoNode node(system, path, name);
  if (node.gives(VideoKind::kDepth)) {
    throw Error("{}: gives depth alone; name the node of colour, too: v4l2:COLOR,{}", name, path);
  }
  if (node.gives(VideoKind::kColor)) {
    throw Error("{}: gives colour alone, without depth; name the node of depth, too: v4l2:{},DEPTH",
                name,
                path);
  }
  throw Error("{}: gives neither colour nor depth, but {}", name, listed_modes(node.modes()));
}

void check_kind(const VideoNode& node, VideoKind kind, const std::string& name) {
  if (node.gives(kind)) return;
  throw Error("{}: {} gives no {}, but {}; expected v4l2:COLOR,DEPTH",
              name,
              node.path(),
              kind == VideoKind::kColor ? "colour" : "depth (Z16)",
              listed_modes(node.modes()));
}

class V4l2Device : public Device {
 public:
  V4l2Device(std::pair<std::string, std::string> paths,
             std::string name,
             const DeviceRequest& request,
             VideoSystem& system)
      : system_(system),
        name_(std::move(name)),
        color_path_(std::move(paths.first)),
        depth_path_(std::move(paths.second)),
        wanted_(sizes_of(request)),
        depth_factor_(request.depth_factor()) {
    open();
    if (request.registered()) warnings_.push_back(not_registered(name_));
  }

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] std::optional<CameraModel> camera() const override { return std::nullopt; }
  [[nodiscard]] std::optional<DeviceImages> wait(double timeout_s) override;
  [[nodiscard]] std::vector<std::string> warnings() const override { return warnings_; }
  [[nodiscard]] std::string choice() const override { return choice_; }

 private:
  void open();
  void close();
  [[nodiscard]] bool open_again();
  [[noreturn]] void refuse_modes() const;
  /// Reads what is ready, after waiting until then where nothing is; returns whether there was
  /// something. Closes nodes that are gone.
  [[nodiscard]] bool read_some(VideoTime until);
  /// The newest pair of one moment that has been read.
  [[nodiscard]] std::optional<DeviceImages> take_pair();

  VideoSystem& system_;
  std::string name_, color_path_, depth_path_;
  WantedSizes wanted_;
  double depth_factor_;
  std::optional<VideoNode> color_, depth_;  // both or none
  ImagePairs<RawVideo, RawVideo> pairs_;
  double same_time_s_ = 0;  // greatest difference between the stamps of images of one moment
  std::vector<std::string> warnings_;
  std::string choice_;
};

void V4l2Device::open() {
  color_.emplace(system_, color_path_, name_);
  depth_.emplace(system_, depth_path_, name_);
  check_kind(*color_, VideoKind::kColor, name_);
  check_kind(*depth_, VideoKind::kDepth, name_);
  const auto modes = choose_video_modes(color_->modes(), depth_->modes(), wanted_);
  if (!modes) refuse_modes();
  color_->start(modes->first);
  depth_->start(modes->second);
  choice_ = fmt::format(
      "colour {}, depth {}", listed_modes({modes->first}), listed_modes({modes->second}));
  const double rate_hz = std::min(modes->first.rate_hz, modes->second.rate_hz);
  same_time_s_ = 0.6 / (rate_hz > 0 ? rate_hz : 30);
}

void V4l2Device::refuse_modes() const {
  const std::string wanted =
      wanted_.color ? fmt::format("the sizes of the camera, {}x{} of colour and {}x{} of depth",
                                  wanted_.color->width,
                                  wanted_.color->height,
                                  wanted_.depth->width,
                                  wanted_.depth->height)
                    : std::string("one size up to 640x480 of both");
  throw Error("{}: does not have {}; {} has {}; {} has {}",
              name_,
              wanted,
              color_path_,
              listed_modes(color_->modes()),
              depth_path_,
              listed_modes(depth_->modes()));
}

void V4l2Device::close() {
  pairs_.clear();
  color_.reset();
  depth_.reset();
}

bool V4l2Device::open_again() {
  try {
    open();
    return true;
  } catch (const Error&) {  // it is not back yet: the next call tries again
    close();
    return false;
  }
}

bool V4l2Device::read_some(VideoTime until) {
  if (!color_ || !depth_) return false;
  std::array<pollfd, 2> waiting = {
      {{color_->descriptor(), POLLIN, 0}, {depth_->descriptor(), POLLIN, 0}}};
  if (system_.poll(waiting, milliseconds_until(until)) <= 0) return false;
  try {
    for (std::size_t i = 0; i < waiting.size(); ++i) {
      if (waiting[i].revents == 0) continue;
      std::optional<RawVideo> raw = (i == 0 ? color_ : depth_)->read();
      if (!raw && (waiting[i].revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) {
        close();
        return false;
      }
      if (!raw) continue;
      const double stamp_s = raw->stamp_s;
      if (i == 0) {
        pairs_.add_color(stamp_s, *std::move(raw));
      } else {
        pairs_.add_depth(stamp_s, *std::move(raw));
      }
    }
    return true;
  } catch (const VideoNodeGone&) {
    close();
    return false;
  }
}

std::optional<DeviceImages> V4l2Device::take_pair() {
  const auto pair = pairs_.take(same_time_s_);
  if (!pair || !color_ || !depth_) return std::nullopt;
  const auto& [color, depth] = *pair;
  DeviceImages images;
  images.stamp_s = color.stamp_s;
  images.depth_stamp_s = depth.stamp_s;
  try {
    images.color = video_color(color.image, color_->layout(), color_path_);
    images.depth = video_depth(depth.image, depth_->layout(), depth_factor_, depth_path_);
  } catch (const Error& error) {
    images.damage = error.what();
  }
  return images;
}

std::optional<DeviceImages> V4l2Device::wait(double timeout_s) {
  const VideoTime until =
      std::chrono::steady_clock::now() +
      std::chrono::duration_cast<VideoTime::duration>(std::chrono::duration<double>(timeout_s));
  constexpr int kMostWaiting = 8;
  bool ready = (color_ || open_again()) && read_some(until);
  while (ready) {
    // What waits in the driver is older than what is to come.
    for (int i = 0; i < kMostWaiting && ready; ++i) ready = read_some({});
    std::optional<DeviceImages> images = take_pair();
    if (images) return images;
    ready = milliseconds_until(until) > 0 && read_some(until);
  }
  // Nodes that are gone are not asked for all the time.
  if (!color_) (void)system_.poll({}, milliseconds_until(until));
  return std::nullopt;
}

}  // namespace

std::unique_ptr<Device> open_v4l2_device(const std::string& which,
                                         const std::string& name,
                                         const DeviceRequest& request,
                                         VideoSystem& system) {
  const std::size_t comma = which.find(',');
  if (comma == std::string::npos) refuse_alone(system, which, name);
  std::pair<std::string, std::string> paths(which.substr(0, comma), which.substr(comma + 1));
  if (paths.first.empty() || paths.second.empty() || paths.second.find(',') != std::string::npos) {
    throw Error("{}: expected v4l2:COLOR,DEPTH, two video nodes", name);
  }
  return std::make_unique<V4l2Device>(std::move(paths), name, request, system);
}

}  // namespace stillmap
