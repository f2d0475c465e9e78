// SPDX-License-Identifier: Apache-2.0
#if STILLMAP_WITH_BEAST
#include "tooling/devices/rosbridge_topics.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"
#include "stillmap/io/image_io.hpp"
#include "tooling/ros/camera_info.hpp"
#include "tooling/ros/ros_topics.hpp"
#include "tooling/ros/rosbridge_message.hpp"

namespace stillmap {
namespace {

using SocketTime = WebSocketClient::Time;

constexpr std::chrono::seconds kAnswers{5};  // for what a robot has to say
constexpr std::chrono::seconds kSamples{3};  // for a message of each topic
constexpr int kOnlyOnceMs = 3'600'000;       // between two messages of a topic

constexpr std::string_view kImageType = "sensor_msgs/Image";
constexpr std::string_view kCompressedType = "sensor_msgs/CompressedImage";
constexpr std::string_view kInfoType = "sensor_msgs/CameraInfo";

class TopicSearch {
 public:
  TopicSearch(WebSocketClient& socket, const std::string& name, const DeviceRequest& request)
      : socket_(socket), name_(name), request_(request) {}

  [[nodiscard]] RosbridgeTopics found() {
    RosbridgeTopics found;
    const std::optional<std::vector<BridgeTopic>> topics = ask_topics();
    if (topics) {
      choose_images(*topics, found);
    } else {
      take_named(found);
    }
    read_infos(info_topic(found.color, topics), info_topic(found.depth, topics), found);
    return found;
  }

 private:
  // The next message that can be read; nothing where none comes until then.
  [[nodiscard]] std::optional<BridgeMessage> next(SocketTime until) {
    while (const std::optional<WebSocketClient::Message> message = socket_.receive(until)) {
      try {
        return read_bridge_message(message->bytes, message->binary, name_);
      } catch (const DamagedImage&) {  // of those that are expected, one may still come
        if (SocketTime::clock::now() >= until) return std::nullopt;
      }
    }
    if (socket_.state() == WebSocketClient::State::kLost) {
      throw Error("{}: the connection was lost ({})", name_, socket_.problem());
    }
    return std::nullopt;
  }

  // Nothing where rosapi does not answer.
  [[nodiscard]] std::optional<std::vector<BridgeTopic>> ask_topics() {
    socket_.send(call_message("/rosapi/topics", "topics"));
    const SocketTime until = SocketTime::clock::now() + kAnswers;
    while (const std::optional<BridgeMessage> message = next(until)) {
      if (message->op != "service_response" || message->id != "topics") continue;
      if (!message->result) return std::nullopt;
      return bridged_topics(message->content, name_);
    }
    return std::nullopt;
  }

  void take_named(RosbridgeTopics& found) const {
    found.color = request_.color_topic;
    found.depth = request_.depth_topic;
    if (!found.color.empty() && !found.depth.empty()) return;
    throw Error(
        "{}: the robot's topics are not known, as its rosapi does not answer; name them with "
        "--color-topic and --depth-topic",
        name_);
  }

  void choose_images(const std::vector<BridgeTopic>& topics, RosbridgeTopics& found) {
    std::vector<ImageTopic> images;
    for (const BridgeTopic& topic : topics) {
      if (topic.type == kImageType) images.push_back({topic.name, RosImageType::kPlain});
      if (topic.type == kCompressedType) images.push_back({topic.name, RosImageType::kCompressed});
    }
    if (request_.color_topic.empty() || request_.depth_topic.empty()) look_at_images(images);
    found.color = choose_color_topic(images, request_.color_topic, name_).name;
    found.depth = choose_depth_topic(images, request_.depth_topic, name_).name;
  }

  // One message of each topic, by topic, as far as they come in time.
  [[nodiscard]] std::map<std::string, nlohmann::json> first_messages(
      const std::set<std::string>& topics, bool cbor) {
    for (const std::string& topic : topics) {
      socket_.send(subscribe_message({topic, cbor, kOnlyOnceMs}));
    }
    std::map<std::string, nlohmann::json> messages;
    const SocketTime until = SocketTime::clock::now() + kSamples;
    while (messages.size() < topics.size()) {
      std::optional<BridgeMessage> message = next(until);
      if (!message) break;
      if (message->op != "publish" || !topics.contains(message->topic)) continue;
      messages.emplace(message->topic, std::move(message->content));
    }
    for (const std::string& topic : topics) socket_.send(unsubscribe_message(topic));
    return messages;
  }

  void look_at_images(std::vector<ImageTopic>& images) {
    std::set<std::string> names;
    for (const ImageTopic& image : images) names.insert(image.name);
    std::map<std::string, nlohmann::json> messages = first_messages(names, true);
    if (messages.empty() && !names.empty()) {
      throw Error("{}: no images came within {} s of {}",
                  name_,
                  kSamples.count(),
                  joined(std::vector<std::string>(names.begin(), names.end()), ", "));
    }
    for (ImageTopic& image : images) {
      const auto message = messages.find(image.name);
      if (message == messages.end()) continue;
      try {
        image.kind = BridgedImage(std::move(message->second), image.name).kind();
      } catch (const DamagedImage&) {  // it is no candidate then
        continue;
      }
    }
  }

  // The topic with the CameraInfo of an image's topic; where the robot does not list its topics,
  // the one beside it.
  [[nodiscard]] static std::string info_topic(
      std::string topic, const std::optional<std::vector<BridgeTopic>>& topics) {
    if (topics) {
      std::vector<std::string> infos;
      for (const BridgeTopic& other : *topics) {
        if (other.type == kInfoType) infos.push_back(other.name);
      }
      return info_topic_of(topic, infos);
    }
    for (const std::string_view transport : {"/compressed", "/compressedDepth"}) {
      if (topic.ends_with(transport)) topic.resize(topic.size() - transport.size());
    }
    return topic.substr(0, topic.rfind('/')) + "/camera_info";
  }

  void read_infos(const std::string& color, const std::string& depth, RosbridgeTopics& found) {
    if (request_.camera && !request_.registered()) return;
    std::set<std::string> names = {color, depth};
    names.erase("");
    // In JSON: some servers cannot put the arrays of a CameraInfo into CBOR.
    const std::map<std::string, nlohmann::json> messages = first_messages(names, false);
    const auto info = [&](const std::string& topic) -> std::optional<RosCameraInfo> {
      const auto message = messages.find(topic);
      if (message == messages.end()) return std::nullopt;
      return bridged_camera_info(message->second, topic);
    };
    if (!request_.camera) found.camera = told_camera(info(color), found.color);
    const std::optional<RosCameraInfo> of_depth = info(depth);
    if (of_depth) check_registered(*of_depth, found);
  }

  [[nodiscard]] CameraModel told_camera(const std::optional<RosCameraInfo>& info,
                                        const std::string& topic) const {
    if (!info) {
      throw Error("{}: no CameraInfo of {} came; name the camera with --camera", name_, topic);
    }
    try {
      return camera_of_info(*info, topic.find("rect") != std::string::npos, topic);
    } catch (const Error& error) {
      throw Error("{}: {}; name the camera with --camera", name_, error.what());
    }
  }

  void check_registered(const RosCameraInfo& depth, RosbridgeTopics& found) const {
    const CameraModel& color = request_.camera ? *request_.camera : *found.camera;
    const cv::Size size(color.width_px, color.height_px);
    if (depth.width_px != static_cast<std::uint32_t>(size.width) ||
        depth.height_px != static_cast<std::uint32_t>(size.height)) {
      throw Error(
          "{}: {} has {}x{} pixels, but {} has {}x{}; expected depth that is registered to colour, "
          "or --camera with a depth camera of its own",
          name_,
          found.depth,
          depth.width_px,
          depth.height_px,
          found.color,
          size.width,
          size.height);
    }
    if (looks_registered(depth, color)) return;
    found.warnings.push_back(
        fmt::format("{} has other intrinsics than {}: depth does not look registered to colour",
                    found.depth,
                    found.color));
  }

  WebSocketClient& socket_;
  const std::string& name_;
  const DeviceRequest& request_;
};

}  // namespace

RosbridgeTopics find_rosbridge_topics(WebSocketClient& socket,
                                      const std::string& name,
                                      const DeviceRequest& request) {
  return TopicSearch(socket, name, request).found();
}

}  // namespace stillmap
#endif
