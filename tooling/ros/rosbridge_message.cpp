// SPDX-License-Identifier: Apache-2.0
#include "tooling/ros/rosbridge_message.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "stillmap/io/image_io.hpp"
#include "tooling/ros/cbor.hpp"

namespace stillmap {
namespace {

using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

// Values are counted while they are read: a number takes more memory than its digits.
json read_json(std::string_view text, const std::string& place) {
  std::size_t values = 0;
  const auto count = [&](int depth, json::parse_event_t event, json&) {
    const bool begins = event == json::parse_event_t::value ||
                        event == json::parse_event_t::object_start ||
                        event == json::parse_event_t::array_start;
    if (begins && ++values > kMaxValues) throw DamagedImage("{}: too many values", place);
    if (depth > kMaxValueDepth) throw DamagedImage("{}: values lie too deep", place);
    return true;
  };
  try {
    return json::parse(text, count);
  } catch (const json::exception&) {
    throw DamagedImage("{}: a message that is no JSON", place);
  }
}

const json* find(const json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

const json& field(const json& object, const char* name, const std::string& place) {
  const json* const found = find(object, name);
  if (found == nullptr) throw DamagedImage("{}: a message without '{}'", place, name);
  return *found;
}

// The field by its name in ROS 1, else in ROS 2.
const json& field(const json& object,
                  const char* ros1,
                  const char* ros2,
                  const std::string& place) {
  const json* const found = find(object, ros1);
  return found != nullptr ? *found : field(object, ros2, place);
}

// Whether a value is a whole number from 0 to `most`.
bool is_whole(const json& value, std::uint64_t most) {
  if (!value.is_number_integer()) return false;
  if (!value.is_number_unsigned() && value.get<std::int64_t>() < 0) return false;
  return value.get<std::uint64_t>() <= most;
}

std::uint32_t number_of(const json& value, const char* name, const std::string& place) {
  if (!is_whole(value, std::numeric_limits<std::uint32_t>::max()))
    throw DamagedImage("{}: '{}' is no number of 32 bits", place, name);
  return value.get<std::uint32_t>();
}

std::uint32_t number(const json& object, const char* name, const std::string& place) {
  return number_of(field(object, name, place), name, place);
}

const std::string& text(const json& object, const char* name, const std::string& place) {
  const json& value = field(object, name, place);
  if (!value.is_string()) throw DamagedImage("{}: '{}' is no text", place, name);
  return value.get_ref<const std::string&>();
}

std::string text_or_empty(const json& object, const char* name) {
  const json* const value = find(object, name);
  return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
}

RosTime stamp_of(const json& message, const std::string& place) {
  const json& stamp = field(field(message, "header", place), "stamp", place);
  return {number_of(field(stamp, "secs", "sec", place), "sec", place),
          number_of(field(stamp, "nsecs", "nanosec", place), "nanosec", place)};
}

constexpr std::string_view kAlphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kNoDigit = 64;
constexpr std::array<std::uint8_t, 256> kDigits = [] {
  std::array<std::uint8_t, 256> digits{};
  digits.fill(kNoDigit);
  for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
    digits[static_cast<std::uint8_t>(kAlphabet[i])] = static_cast<std::uint8_t>(i);
  }
  return digits;
}();

Bytes from_base64(std::string_view text, const std::string& place) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  Bytes bytes;
  bytes.reserve(text.size() * 3 / 4);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::uint8_t digit = kDigits[static_cast<std::uint8_t>(c)];
    if (digit == kNoDigit) throw DamagedImage("{}: data that is no base64", place);
    bits = bits << 6U | digit;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> static_cast<unsigned>(count)));
  }
  return bytes;
}

Bytes from_numbers(const json& numbers, const std::string& place) {
  Bytes bytes;
  for (const json& value : numbers) {
    if (!is_whole(value, 255)) throw DamagedImage("{}: data with a number that is no byte", place);
    bytes.push_back(value.get<std::uint8_t>());
  }
  return bytes;
}

Bytes bytes_of(json& value, const std::string& place) {
  if (value.is_binary()) return std::move(static_cast<Bytes&>(value.get_binary()));
  if (value.is_string()) return from_base64(value.get_ref<const std::string&>(), place);
  if (value.is_array()) return from_numbers(value, place);
  throw DamagedImage("{}: a message without bytes in 'data'", place);
}

// Of typed arrays of CBOR (RFC 8746), little-endian.
template <class Number>
std::vector<double> unpacked(const Bytes& bytes) {
  std::vector<double> numbers;
  for (std::size_t at = 0; at + sizeof(Number) <= bytes.size(); at += sizeof(Number)) {
    Number number{};
    std::memcpy(&number, bytes.data() + at, sizeof(Number));
    numbers.push_back(static_cast<double>(number));
  }
  return numbers;
}

std::vector<double> numbers_of(const json& value, const char* name, const std::string& place) {
  constexpr std::uint64_t kFloat32 = 85, kFloat64 = 86;
  constexpr std::size_t kMost = 64;
  std::vector<double> numbers;
  if (value.is_binary() && value.get_binary().size() <= kMost * sizeof(double)) {
    const auto& bytes = value.get_binary();
    if (bytes.has_subtype() && bytes.subtype() == kFloat32) numbers = unpacked<float>(bytes);
    if (bytes.has_subtype() && bytes.subtype() == kFloat64) numbers = unpacked<double>(bytes);
  } else if (value.is_array() && value.size() <= kMost) {
    for (const json& number : value) {
      if (!number.is_number()) throw DamagedImage("{}: '{}' is no list of numbers", place, name);
      numbers.push_back(number.get<double>());
    }
  } else {
    throw DamagedImage("{}: '{}' is no list of some numbers", place, name);
  }
  return numbers;
}

template <std::size_t N>
std::array<double, N> exactly(const std::vector<double>& numbers,
                              const char* name,
                              const std::string& place) {
  if (numbers.size() != N) {
    throw DamagedImage("{}: '{}' has {} numbers, expected {}", place, name, numbers.size(), N);
  }
  std::array<double, N> array{};
  std::ranges::copy(numbers, array.begin());
  return array;
}

// "sensor_msgs/Image" of ROS 2's "sensor_msgs/msg/Image".
std::string type_of_ros1(std::string type) {
  constexpr std::string_view kPart = "/msg";
  const std::size_t at = type.find("/msg/");
  if (at != std::string::npos) type.erase(at, kPart.size());
  return type;
}

std::string_view view_of(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Texts of a server go back to it, whatever they hold.
std::string dumped(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

BridgeMessage read_bridge_message(std::string_view bytes, bool binary, const std::string& place) {
  json whole = binary ? read_cbor(bytes, place) : read_json(bytes, place);
  BridgeMessage message;
  message.op = text(whole, "op", place);
  message.topic = text_or_empty(whole, "topic");
  message.id = text_or_empty(whole, "id");
  const json* const result = find(whole, "result");
  message.result = result != nullptr && result->is_boolean() && result->get<bool>();
  for (const char* name : {"msg", "values"}) {
    if (find(whole, name) != nullptr) message.content = std::move(whole[name]);
  }
  return message;
}

BridgedImage::BridgedImage(json content, const std::string& place)
    : stamp_(stamp_of(content, place)) {
  if (find(content, "format") != nullptr) {
    type_ = RosImageType::kCompressed;
    encoding_ = text(content, "format", place);
  } else {
    encoding_ = text(content, "encoding", place);
    height_px_ = number(content, "height", place);
    width_px_ = number(content, "width", place);
    row_bytes_ = number(content, "step", place);
    const json& order = field(content, "is_bigendian", place);
    big_endian_ =
        order.is_boolean() ? order.get<bool>() : number(content, "is_bigendian", place) != 0;
  }
  (void)field(content, "data", place);
  bytes_ = bytes_of(content["data"], place);
}

RosImage BridgedImage::plain() const {
  return {stamp_, height_px_, width_px_, encoding_, big_endian_, row_bytes_, view_of(bytes_)};
}

RosCompressedImage BridgedImage::compressed() const {
  return {stamp_, encoding_, view_of(bytes_)};
}

RosImageKind BridgedImage::kind() const {
  return type_ == RosImageType::kPlain ? ros_image_kind(plain()) : ros_image_kind(compressed());
}

ColorImage BridgedImage::color(const std::string& place) const {
  return type_ == RosImageType::kPlain ? decode_ros_color(plain(), place)
                                       : decode_ros_color(compressed(), place);
}

DepthImage BridgedImage::depth(double depth_factor, const std::string& place) const {
  return type_ == RosImageType::kPlain ? decode_ros_depth(plain(), depth_factor, place)
                                       : decode_ros_depth(compressed(), depth_factor, place);
}

RosCameraInfo bridged_camera_info(const json& content, const std::string& place) {
  RosCameraInfo info;
  info.height_px = number(content, "height", place);
  info.width_px = number(content, "width", place);
  info.distortion_model = text(content, "distortion_model", place);
  info.distortion = numbers_of(field(content, "D", "d", place), "D", place);
  info.intrinsics = exactly<9>(numbers_of(field(content, "K", "k", place), "K", place), "K", place);
  info.projection =
      exactly<12>(numbers_of(field(content, "P", "p", place), "P", place), "P", place);
  return info;
}

std::vector<BridgeTopic> bridged_topics(const json& values, const std::string& place) {
  const json& names = field(values, "topics", place);
  const json& types = field(values, "types", place);
  if (!names.is_array() || !types.is_array() || names.size() != types.size()) {
    throw DamagedImage("{}: /rosapi/topics gives no list of topics with their types", place);
  }
  std::vector<BridgeTopic> topics;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!names[i].is_string() || !types[i].is_string()) continue;
    topics.push_back({names[i].get<std::string>(), type_of_ros1(types[i].get<std::string>())});
  }
  return topics;
}

std::string subscribe_message(const BridgeSubscription& subscription) {
  return dumped({{"op", "subscribe"},
                 {"id", "subscribe:" + subscription.topic},
                 {"topic", subscription.topic},
                 {"compression", subscription.cbor ? "cbor" : "none"},
                 {"throttle_rate", subscription.throttle_ms},
                 {"queue_length", 1}});
}

std::string unsubscribe_message(const std::string& topic) {
  return dumped({{"op", "unsubscribe"}, {"id", "subscribe:" + topic}, {"topic", topic}});
}

std::string call_message(const std::string& service, const std::string& id) {
  return dumped({{"op", "call_service"}, {"id", id}, {"service", service}});
}

}  // namespace stillmap
