// SPDX-License-Identifier: Apache-2.0
#include "tooling/recordings/ros_bag.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/input_file.hpp"
#include "stillmap/sensor/pair_images.hpp"
#include "tooling/recordings/bag_file.hpp"
#include "tooling/ros/camera_info.hpp"
#include "tooling/ros/ros_image.hpp"
#include "tooling/ros/ros_topics.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kImage = "sensor_msgs/Image";
constexpr std::string_view kCompressedImage = "sensor_msgs/CompressedImage";
constexpr std::string_view kCameraInfo = "sensor_msgs/CameraInfo";
constexpr std::string_view kFloat = "std_msgs/Float32";

// The images of one topic in the order of their stamps.
struct ImageMessages {
  std::size_t topic = 0;
  RosImageType type = RosImageType::kPlain;
  ImageList list;                     // no files
  std::vector<std::size_t> messages;  // of the topic, one for each image
};

// The images of the pairs.
struct BagPair {
  std::size_t color_message, depth_message;
};

class BagImages : public ImageReader {
 public:
  BagImages(std::shared_ptr<const BagFile> bag,
            const ImageMessages& color,
            const ImageMessages& depth,
            double depth_factor,
            std::vector<BagPair> pairs)
      : bag_(std::move(bag)),
        color_topic_(color.topic),
        depth_topic_(depth.topic),
        color_type_(color.type),
        depth_type_(depth.type),
        color_name_(color.list.name),
        depth_name_(depth.list.name),
        depth_factor_(depth_factor),
        pairs_(std::move(pairs)) {}

  [[nodiscard]] ColorFile color(std::size_t index) const override {
    const std::string message = read(color_topic_, pairs_.at(index).color_message);
    return {decode_ros_color(message, color_type_, name(color_name_, index)), {}};
  }
  [[nodiscard]] DepthImage depth(std::size_t index, double) const override {
    const std::string message = read(depth_topic_, pairs_.at(index).depth_message);
    return decode_ros_depth(message, depth_type_, depth_factor_, name(depth_name_, index));
  }

 private:
  [[nodiscard]] static std::string name(const std::string& topic, std::size_t index) {
    return fmt::format("{}, frame {}", topic, index);
  }
  [[nodiscard]] std::string read(std::size_t topic, std::size_t message) const {
    const std::lock_guard lock(one_at_a_time_);
    return bag_->read(topic, message);
  }

  std::shared_ptr<const BagFile> bag_;
  mutable std::mutex one_at_a_time_;
  std::size_t color_topic_, depth_topic_;
  RosImageType color_type_, depth_type_;
  std::string color_name_, depth_name_;
  double depth_factor_;
  std::vector<BagPair> pairs_;
};

RosImageType type_of(const BagTopic& topic) {
  return topic.type == kImage ? RosImageType::kPlain : RosImageType::kCompressed;
}

std::vector<ImageTopic> image_topics(const BagFile& bag) {
  std::vector<ImageTopic> topics;
  for (std::size_t i = 0; i < bag.topics().size(); ++i) {
    const BagTopic& topic = bag.topics()[i];
    if (topic.type != kImage && topic.type != kCompressedImage) continue;
    const RosImageKind kind = ros_image_kind(bag.read(i, 0), type_of(topic), topic.name);
    topics.push_back({topic.name, type_of(topic), kind});
  }
  return topics;
}

std::size_t index_of(const BagFile& bag, const std::string& name) {
  const auto found = std::ranges::find(bag.topics(), name, &BagTopic::name);
  STILLMAP_CHECK(found != bag.topics().end());
  return static_cast<std::size_t>(found - bag.topics().begin());
}

Stamp stamp_of(const RosTime& time) {
  return {time.seconds + 1e-9 * time.nanoseconds,
          fmt::format("{}.{:09}", time.seconds, time.nanoseconds)};
}

// Messages in the order of their stamps; those with the stamp of another are left out.
ImageMessages read_stamps(const BagFile& bag, const ImageTopic& topic) {
  ImageMessages images{index_of(bag, topic.name), topic.type, {topic.name, {}, {}}, {}};
  std::vector<std::pair<Stamp, std::size_t>> stamped;
  const std::size_t count = bag.topics()[images.topic].messages;
  for (std::size_t i = 0; i < count; ++i) {
    stamped.emplace_back(stamp_of(parse_ros_stamp(bag.read(images.topic, i), topic.name)), i);
  }
  std::ranges::stable_sort(stamped, {}, [](const auto& image) { return image.first.seconds; });
  for (auto& [stamp, message] : stamped) {
    if (!images.messages.empty() && images.list.images.back().stamp.seconds == stamp.seconds)
      continue;
    images.list.images.push_back({std::move(stamp), {}});
    images.messages.push_back(message);
  }
  if (images.messages.size() < count) {
    images.list.remarks.warnings.push_back(
        fmt::format("{}: {} images have the stamp of another and are left out",
                    topic.name,
                    count - images.messages.size()));
  }
  return images;
}

// The unit of 16-bit depth: millimetres, but for recorders that say otherwise, as RealSense's does.
double depth_factor_of(const BagFile& bag) {
  for (std::size_t i = 0; i < bag.topics().size(); ++i) {
    const BagTopic& topic = bag.topics()[i];
    if (topic.type != kFloat || topic.name.find("Depth Units") == std::string::npos) continue;
    const float unit_m = parse_ros_float(bag.read(i, 0), topic.name);
    if (unit_m > 0 && unit_m < 1) return std::round(1e6 / static_cast<double>(unit_m)) / 1e6;
  }
  return 1000;
}

std::optional<RosCameraInfo> info_of(const BagFile& bag, const std::string& topic) {
  std::vector<std::string> names;
  for (const BagTopic& other : bag.topics()) {
    if (other.type == kCameraInfo) names.push_back(other.name);
  }
  const std::string name = info_topic_of(topic, names);
  if (name.empty()) return std::nullopt;
  return parse_ros_camera_info(bag.read(index_of(bag, name), 0), name);
}

// The camera that takes the colour images, or why it is not known.
struct ToldCamera {
  std::optional<CameraModel> camera;
  std::string problem;
};

ToldCamera told_camera(const BagFile& bag, const std::string& topic) {
  const std::optional<RosCameraInfo> info = info_of(bag, topic);
  if (!info) return {{}, fmt::format("no CameraInfo for {}", topic)};
  try {
    return {camera_of_info(*info, topic.find("rect") != std::string::npos, topic), ""};
  } catch (const Error& error) {
    return {{}, error.what()};
  }
}

void check_sizes(const ImageReader& images, const std::string& color, const std::string& depth) {
  const cv::Size color_px = images.color(0).color.mat.size(),
                 depth_px = images.depth(0, 1).mat.size();
  if (color_px == depth_px) return;
  throw Error("{}: {}x{} pixels, but {} has {}x{}; expected depth that is registered to colour",
              depth,
              depth_px.width,
              depth_px.height,
              color,
              color_px.width,
              color_px.height);
}

// Whether depth has the intrinsics of colour, as it has when it is registered, or none of its own.
bool same_intrinsics(const BagFile& bag, const CameraModel& color, const std::string& depth) {
  const std::optional<RosCameraInfo> info = info_of(bag, depth);
  return !info || looks_registered(*info, color);
}

}  // namespace

bool is_ros_bag(const fs::path& path) {
  constexpr std::string_view kMagic = "#ROSBAG V";
  try {
    const InputFile file(path);
    return file.size() >= kMagic.size() && file.read(0, kMagic.size()) == kMagic;
  } catch (const Error&) {
    return false;
  }
}

SequenceContent open_ros_bag(const fs::path& path, const ReadingOptions& options) {
  const auto bag =
      std::make_shared<const BagFile>(path,
                                      std::vector<std::string>{std::string(kImage),
                                                               std::string(kCompressedImage),
                                                               std::string(kCameraInfo),
                                                               std::string(kFloat)});
  const std::vector<ImageTopic> topics = image_topics(*bag);
  const ImageMessages color =
      read_stamps(*bag, choose_color_topic(topics, options.color_topic, path.string()));
  const ImageMessages depth =
      read_stamps(*bag, choose_depth_topic(topics, options.depth_topic, path.string()));
  const PairedImages paired = pair_by_stamp(color.list, depth.list, path.string());
  SequenceContent content;
  content.entries = entries_of(paired, color.list, depth.list);
  std::vector<BagPair> pairs;
  for (const auto& [i, j] : paired.pairs) pairs.push_back({color.messages[i], depth.messages[j]});
  content.images =
      std::make_shared<BagImages>(bag, color, depth, depth_factor_of(*bag), std::move(pairs));
  content.remarks.notes.push_back(
      fmt::format("colour {}, depth {}", color.list.name, depth.list.name));
  for (const Remarks* remarks : {&color.list.remarks, &depth.list.remarks, &paired.remarks}) {
    content.remarks.add(*remarks);
  }
  check_sizes(*content.images, color.list.name, depth.list.name);
  ToldCamera told = told_camera(*bag, color.list.name);
  if (told.camera && !same_intrinsics(*bag, *told.camera, depth.list.name)) {
    content.remarks.warnings.push_back(
        fmt::format("{} has other intrinsics than {}: depth does not look registered to colour",
                    depth.list.name,
                    color.list.name));
  }
  content.camera = std::move(told.camera);
  content.no_camera = std::move(told.problem);
  return content;
}

}  // namespace stillmap
