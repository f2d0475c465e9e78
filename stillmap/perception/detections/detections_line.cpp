// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/detections/detections_line.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/io/stamp_text.hpp"
#include "stillmap/perception/detections/class_names.hpp"

namespace stillmap {
namespace {

using Json = nlohmann::json;

// 255 objects take less than 40 KiB. The limit keeps hostile files from exhausting memory.
constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20U;

// Quotes any text as one line of ASCII.
std::string quoted(const std::string& text) {
  return Json(text).dump(-1, ' ', true, Json::error_handler_t::replace);
}

const Json& member(const Json& object, const char* key, const std::string& place) {
  const Json::const_iterator found = object.find(key);
  if (found == object.end()) throw Error("{}: no '{}' in it", place, key);
  return *found;
}

Stamp stamp_of(const Json& value, const std::string& place) {
  if (!value.is_string()) {
    throw Error("{}: stamp is not a text, expected one such as \"1341846313.592026\"", place);
  }
  const std::string text = value.get<std::string>();
  if (std::optional<Stamp> stamp = parse_stamp(text)) return *std::move(stamp);
  throw Error(
      "{}: stamp {} is no finite number of at most {} characters, expected one such as "
      "\"1341846313.592026\"",
      place,
      quoted(text.substr(0, kMaxStampLength)),
      kMaxStampLength);
}

int parse_id(const Json& value, const std::string& place) {
  const bool whole = value.is_number_integer();
  const bool fits = whole && (!value.is_number_unsigned() || value.get<std::uint64_t>() <= 255U);
  const std::int64_t id = fits ? value.get<std::int64_t>() : 0;
  if (id < 1 || id > 255) throw Error("{}: id is not a whole number from 1 to 255", place);
  return static_cast<int>(id);
}

std::string parse_class(const Json& value, const std::string& place) {
  const std::string name = value.is_string() ? value.get<std::string>() : std::string();
  if (!is_class_name(name)) {
    throw Error(
        "{}: class is not a text of 1 to {} bytes without control characters, such as "
        "\"person\"",
        place,
        kMaxClassNameBytes);
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

struct NamedOrigin {
  std::string_view name;
  PixelSource origin;
};
// A network's masks have no such entry.
constexpr std::array kOrigins = {NamedOrigin{"rough", PixelSource::kRoughNetwork},
                                 NamedOrigin{"depth", PixelSource::kDepth}};

PixelSource parse_origin(const Json& object, const std::string& place) {
  const Json::const_iterator found = object.find("mask");
  if (found == object.end()) return PixelSource::kNetwork;
  const std::string text = found->is_string() ? found->get<std::string>() : std::string();
  const auto* known = std::ranges::find(kOrigins, text, &NamedOrigin::name);
  if (known != kOrigins.end()) return known->origin;
  throw Error(R"({}: mask is neither "rough" nor "depth")", place);
}

std::string format_origin(PixelSource origin) {
  const auto* known = std::ranges::find(kOrigins, origin, &NamedOrigin::origin);
  return known == kOrigins.end() ? "" : fmt::format(R"(,"mask":"{}")", known->name);
}

DetectedObject parse_object(const Json& value, cv::Size image, const std::string& place) {
  if (!value.is_object()) throw Error("{}: an element of 'objects' is no object", place);
  DetectedObject object;
  object.id = parse_id(member(value, "id", place), place);
  const std::string of = fmt::format("{}: object {}", place, object.id);
  object.class_name = parse_class(member(value, "class", of), of);
  object.score = parse_score(member(value, "score", of), of);
  object.box = parse_box(member(value, "box", of), image, of);
  object.pixel_source = parse_origin(value, of);
  return object;
}

std::string format_object(const DetectedObject& object) {
  const PixelBox& box = object.box;
  return fmt::format(R"({{"id":{},"class":{},"score":{},"box":[{},{},{},{}]{}}})",
                     object.id,
                     quoted(object.class_name),
                     object.score,
                     box.x0,
                     box.y0,
                     box.x1,
                     box.y1,
                     format_origin(object.pixel_source));
}

}  // namespace

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
  line.stamp = stamp_of(member(root, "stamp", place), place);
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
  return fmt::format(R"({{"stamp":{},"objects":[{}]}})", quoted(stamp_text(frame.stamp)), objects);
}

}  // namespace stillmap
