// SPDX-License-Identifier: Apache-2.0
#include "tooling/devices/rosbridge_device.hpp"

#include "stillmap/core/error.hpp"
#include "tooling/devices/stream_url.hpp"

#if STILLMAP_WITH_BEAST

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "stillmap/io/image_io.hpp"
#include "tooling/devices/image_pairs.hpp"
#include "tooling/devices/rosbridge_topics.hpp"
#include "tooling/devices/web_socket.hpp"
#include "tooling/ros/rosbridge_message.hpp"

namespace stillmap {
namespace {

using StreamTime = WebSocketClient::Time;
using StreamState = WebSocketClient::State;

constexpr std::chrono::seconds kBetweenAttempts{1};
constexpr double kSameTimeS = 0.02;    // as of the images of recordings
constexpr double kMillimetres = 1000;  // the unit of 16-bit depth in ROS, as in bags

double stamp_seconds(const RosTime& stamp) {
  return stamp.seconds + 1e-9 * stamp.nanoseconds;
}

class RosbridgeDevice : public Device {
 public:
  RosbridgeDevice(StreamUrl url, std::string name, const DeviceRequest& request)
      : name_(std::move(name)), socket_(std::move(url)) {
    connect_first();
    topics_ = find_rosbridge_topics(socket_, name_, request);
    subscribe();
  }

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] std::optional<CameraModel> camera() const override { return topics_.camera; }
  [[nodiscard]] std::optional<DeviceImages> wait(double timeout_s) override;
  [[nodiscard]] std::vector<std::string> warnings() const override { return topics_.warnings; }
  [[nodiscard]] std::string choice() const override {
    return fmt::format("colour {}, depth {}", topics_.color, topics_.depth);
  }

 private:
  void connect_first();
  void subscribe();
  /// Whether it is connected by then.
  [[nodiscard]] bool connected(StreamTime until);
  /// Reads one message; returns whether there was one.
  [[nodiscard]] bool read_one(StreamTime until);
  void read_image(std::string_view bytes, bool binary);
  [[nodiscard]] std::optional<DeviceImages> take_pair();
  /// What was damaged and had no stamp, as if it had come in time.
  [[nodiscard]] std::optional<DeviceImages> take_damage();

  std::string name_;
  WebSocketClient socket_;
  RosbridgeTopics topics_;
  StreamTime next_attempt_;
  bool subscribed_ = false;
  ImagePairs<BridgedImage, BridgedImage> pairs_;
  std::string damage_;
  double last_stamp_s_ = 0;  // of the last images, and when they were taken out
  StreamTime last_taken_ = StreamTime::clock::now();
};

void RosbridgeDevice::connect_first() {
  socket_.connect();
  while (socket_.state() == StreamState::kConnecting) {
    socket_.wait(StreamTime::clock::now() + kBetweenAttempts);
  }
  next_attempt_ = StreamTime::clock::now() + kBetweenAttempts;
  if (socket_.state() == StreamState::kOpen) return;
  throw Error(
      "{}: cannot be connected to ({}); does rosbridge run there?", name_, socket_.problem());
}

void RosbridgeDevice::subscribe() {
  for (const std::string& topic : {topics_.color, topics_.depth}) {
    socket_.send(subscribe_message({topic, true, 0}));
  }
  subscribed_ = true;
}

bool RosbridgeDevice::connected(StreamTime until) {
  while (socket_.state() != StreamState::kOpen) {
    pairs_.clear();
    subscribed_ = false;
    const StreamTime now = StreamTime::clock::now();
    if (now >= until) return false;
    if (socket_.state() == StreamState::kLost && now >= next_attempt_) {
      socket_.connect();
      next_attempt_ = now + kBetweenAttempts;
    }
    const bool lost = socket_.state() == StreamState::kLost;
    socket_.wait(lost ? std::min(until, next_attempt_) : until);
  }
  if (!subscribed_) subscribe();
  return true;
}

void RosbridgeDevice::read_image(std::string_view bytes, bool binary) {
  BridgeMessage message = read_bridge_message(bytes, binary, name_);
  const bool is_color = message.topic == topics_.color, is_depth = message.topic == topics_.depth;
  if (message.op != "publish" || (!is_color && !is_depth)) return;
  BridgedImage image(std::move(message.content), message.topic);
  const double stamp_s = stamp_seconds(image.stamp());
  if (is_color) {
    pairs_.add_color(stamp_s, std::move(image));
  } else {
    pairs_.add_depth(stamp_s, std::move(image));
  }
}

bool RosbridgeDevice::read_one(StreamTime until) {
  const std::optional<WebSocketClient::Message> message = socket_.receive(until);
  if (!message) {
    if (socket_.refused_message()) damage_ = socket_.problem();
    return false;
  }
  try {
    read_image(message->bytes, message->binary);
  } catch (const DamagedImage& error) {
    damage_ = error.what();
  }
  return true;
}

std::optional<DeviceImages> RosbridgeDevice::take_pair() {
  const auto pair = pairs_.take(kSameTimeS);
  if (!pair) return std::nullopt;
  const auto& [color, depth] = *pair;
  DeviceImages images;
  images.stamp_s = color.stamp_s;
  images.depth_stamp_s = depth.stamp_s;
  last_stamp_s_ = color.stamp_s;
  last_taken_ = StreamTime::clock::now();
  try {
    images.color = color.image.color(topics_.color);
    images.depth = depth.image.depth(kMillimetres, topics_.depth);
  } catch (const Error& error) {
    images.damage = error.what();
  }
  return images;
}

std::optional<DeviceImages> RosbridgeDevice::take_damage() {
  if (damage_.empty()) return std::nullopt;
  const std::chrono::duration<double> since = StreamTime::clock::now() - last_taken_;
  DeviceImages images;
  images.stamp_s = images.depth_stamp_s = last_stamp_s_ + since.count();
  images.damage = std::exchange(damage_, {});
  return images;
}

std::optional<DeviceImages> RosbridgeDevice::wait(double timeout_s) {
  constexpr int kMostWaiting = 8;
  const StreamTime until =
      StreamTime::clock::now() +
      std::chrono::duration_cast<StreamTime::duration>(std::chrono::duration<double>(timeout_s));
  do {
    bool ready = connected(until) && read_one(until);
    // What has arrived already is older than what is to come.
    for (int i = 0; i < kMostWaiting && ready; ++i) ready = read_one({});
    std::optional<DeviceImages> images = take_damage();
    if (!images) images = take_pair();
    if (images) return images;
  } while (StreamTime::clock::now() < until);
  return std::nullopt;
}

}  // namespace

bool has_streams() {
  return true;
}

std::unique_ptr<Device> open_rosbridge_device(const std::string& url,
                                              const std::string& name,
                                              const DeviceRequest& request) {
  return std::make_unique<RosbridgeDevice>(parse_stream_url(url, name), name, request);
}

}  // namespace stillmap

#else

namespace stillmap {

bool has_streams() {
  return false;
}

std::unique_ptr<Device> open_rosbridge_device(const std::string& url,
                                              const std::string& name,
                                              const DeviceRequest& /*request*/) {
  (void)parse_stream_url(url, name);
  throw Error("{}: this build reads no streams; install libboost-dev and configure and build again",
              name);
}

}  // namespace stillmap

#endif
