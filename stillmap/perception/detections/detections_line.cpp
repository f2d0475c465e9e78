// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/detections/detections_line.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/detections/class_names.hpp"

namespace stillmap {
namespace {

using Json = nlohmann::json;

// 255 objects take less than 40 KiB. The limit keeps hostile files from exhausting memory.
constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20U;
constexpr std::size_t kMaxStampLength = 32;
constexpr std::size_t kMaxClassLength = 64;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Quotes any text as one line of ASCII.
std::string quoted(const std::string& text) {
  return Json(text).dump(-1, ' ', true, Json::error_handler_t::replace);
}

const Json& member(const Json& object, const char* key, const std::string& place) {
  const Json::const_iterator found = object.find(key);
  if (found == object.end()) throw Error("{}: no '{}' in it", place, key);
  return *found;
}

Stamp parse_stamp(const Json& value, const std::string& place) {
  if (!value.is_string()) {
    throw Error("{}: stamp is not a text, expected one such as \"1341846313.592026\"", place);
  }
  Stamp stamp;
  stamp.text = value.get<std::string>();
  if (!is_plain_number(stamp.text)) {
    throw Error("{}: stamp {} is no plain number, expected one such as \"1341846313.592026\"",
                place,
                quoted(stamp.text.substr(0, 2 * kMaxStampLength)));
  }
  const char* end = stamp.text.data() + stamp.text.size();
  const auto [parsed, status] = std::from_chars(stamp.text.data(), end, stamp.seconds);
  STILLMAP_CHECK(status == std::errc() && parsed == end);
  return stamp;
}

int parse_id(const Json& value, const std::string& place) {
  const bool whole = value.is_number_integer();
  const bool fits = whole && (!value.is_number_unsigned() || value.get<std::uint64_t>() <= 255U);
  const std::int64_t id = fits ? value.get<std::int64_t>() : 0;
  if (id < 1 || id > 255) throw Error("{}: id is not a whole number from 1 to 255", place);
  return static_cast<int>(id);
}

std::string parse_class(const Json& value, const std::string& place) {
  const bool text = value.is_string();
  const std::string name = text ? value.get<std::string>() : std::string();
  const bool printable = std::ranges::all_of(name, [](char c) { return c >= ' ' && c <= '~'; });
  if (name.empty() || name.size() > kMaxClassLength || !printable) {
    throw Error("{}: class is not a text of 1 to {} printable characters, such as \"person\"",
                place,
                kMaxClassLength);
  }
  return coco_name(name);
}

float parse_score(const Json& value, const std::string& place) {
  const double score = value.is_number() ? value.get<double>() : -1.0;
  if (!(score >= 0.0 && score <= 1.0)) throw Error("{}: score is not a number in [0, 1]", place);
  return static_cast<float>(score);
}

PixelBox parse_box(const Json& value, cv::Size image, const std::string& place) {
  std::array<double, 4> sides{};
  if (!value.is_array() || value.size() != sides.size()) {
    throw Error("{}: box is not [x0, y0, x1, y1]", place);
  }
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (!value[i].is_number()) throw Error("{}: box is not four numbers", place);
    sides[i] = value[i].get<double>();
    const double side_px = i % 2 == 0 ? image.width : image.height;
    if (!(sides[i] >= -side_px && sides[i] <= 2.0 * side_px)) {
      throw Error(
          "{}: box reaches to {}, too far out of an image of {}x{} pixels; is it of another "
          "sequence?",
          place,
          sides[i],
          image.width,
          image.height);
    }
  }
  const PixelBox box{sides[0], sides[1], sides[2], sides[3]};
  if (box.x1 <= box.x0 || box.y1 <= box.y0) {
    throw Error(
        "{}: box [{}, {}, {}, {}] holds nothing, expected [x0, y0, x1, y1] with x0 < x1 and y0 < "
        "y1; is it COCO's [x, y, width, height]?",
        place,
        box.x0,
        box.y0,
        box.x1,
        box.y1);
  }
  return box;
}

DetectedObject parse_object(const Json& value, cv::Size image, const std::string& place) {
  if (!value.is_object()) throw Error("{}: an element of 'objects' is no object", place);
  DetectedObject object;
  object.id = parse_id(member(value, "id", place), place);
  const std::string of = fmt::format("{}: object {}", place, object.id);
  object.class_name = parse_class(member(value, "class", of), of);
  object.score = parse_score(member(value, "score", of), of);
  object.box = parse_box(member(value, "box", of), image, of);
  return object;
}

std::string format_object(const DetectedObject& object) {
  const PixelBox& box = object.box;
  return fmt::format(R"({{"id":{},"class":{},"score":{},"box":[{},{},{},{}]}})",
                     object.id,
                     quoted(object.class_name),
                     object.score,
                     box.x0,
                     box.y0,
                     box.x1,
                     box.y1);
}

}  // namespace

bool is_plain_number(std::string_view text) {
  if (text.size() > kMaxStampLength) return false;
  const std::size_t point = std::min(text.find('.'), text.size());
  const std::string_view whole = text.substr(0, point);
  if (whole.empty() || !std::ranges::all_of(whole, is_digit)) return false;
  if (point == text.size()) return true;
  const std::string_view fraction = text.substr(point + 1);
  return !fraction.empty() && std::ranges::all_of(fraction, is_digit);
}

DetectionsLine parse_detections_line(std::string_view text,
                                     cv::Size image,
                                     const std::string& place) {
  if (text.size() > kMaxLineBytes) {
    throw Error("{}: the line is longer than {} bytes", place, kMaxLineBytes);
  }
  const Json root = Json::parse(text, nullptr, false);
  if (!root.is_object()) {
    throw Error(R"({}: no JSON object, expected {{"stamp":"...","objects":[...]}})", place);
  }
  DetectionsLine line;
  line.stamp = parse_stamp(member(root, "stamp", place), place);
  const Json& objects = member(root, "objects", place);
  if (!objects.is_array()) throw Error("{}: 'objects' is no list", place);
  std::set<int> ids;
  for (const Json& value : objects) {
    line.objects.push_back(parse_object(value, image, place));
    const int id = line.objects.back().id;
    if (!ids.insert(id).second) throw Error("{}: id {} stands twice", place, id);
  }
  return line;
}

std::string format_detections_line(const FrameDetections& frame) {
  std::string objects;
  for (const DetectedObject& object : frame.objects) {
    if (!objects.empty()) objects += ',';
    objects += format_object(object);
  }
  return fmt::format(R"({{"stamp":{},"objects":[{}]}})", quoted(frame.stamp.text), objects);
}

}  // namespace stillmap
