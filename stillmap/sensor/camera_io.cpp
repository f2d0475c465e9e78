// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/camera_io.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>
#include <yaml-cpp/yaml.h>

#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"
#include "stillmap/core/nearest_name.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/png_codec.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMaxYamlBytes = std::size_t{1} << 20U;
constexpr std::size_t kMaxTruthBytes = std::size_t{1} << 30U;

struct NumberKey {
  std::string_view key;
  double CameraModel::*member;
  bool required;
};

constexpr std::array<NumberKey, 11> kNumbers = {
    {{"fx", &CameraModel::fx, true},
     {"fy", &CameraModel::fy, true},
     {"cx", &CameraModel::cx, true},
     {"cy", &CameraModel::cy, true},
     {"k1", &CameraModel::k1, false},
     {"k2", &CameraModel::k2, false},
     {"p1", &CameraModel::p1, false},
     {"p2", &CameraModel::p2, false},
     {"k3", &CameraModel::k3, false},
     {"depth_factor", &CameraModel::depth_factor, false},
     {"readout_s", &CameraModel::readout_s, false}}};

struct SizeKey {
  std::string_view key;
  int CameraModel::*member;
};

constexpr std::array<SizeKey, 2> kSizes = {
    {{"width", &CameraModel::width_px}, {"height", &CameraModel::height_px}}};

std::vector<std::string> known_keys() {
  std::vector<std::string> keys = {"name"};
  for (const SizeKey& size : kSizes) keys.emplace_back(size.key);
  for (const NumberKey& number : kNumbers) keys.emplace_back(number.key);
  return keys;
}

// Independent of the locale, and strict: the whole text is the number.
template <class Number>
std::optional<Number> parse(const std::string& text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [parsed, status] = std::from_chars(text.data(), end, value);
  if (status != std::errc() || parsed != end) return std::nullopt;
  return value;
}

void set_value(CameraModel& camera,
               const std::string& key,
               const std::string& value,
               const std::string& place) {
  if (key == "name") camera.name = value;
  for (const SizeKey& size : kSizes) {
    if (size.key != key) continue;
    const std::optional<int> number = parse<int>(value);
    if (!number) throw Error("{}: {} is '{}', expected a whole number", place, key, value);
    camera.*size.member = *number;
  }
  for (const NumberKey& entry : kNumbers) {
    if (entry.key != key) continue;
    const std::optional<double> number = parse<double>(value);
    if (!number || !std::isfinite(*number)) {
      throw Error("{}: {} is '{}', expected a finite number", place, key, value);
    }
    camera.*entry.member = *number;
  }
}

void require_keys(const std::set<std::string>& seen, const std::string& file) {
  std::vector<std::string> missing;
  for (const SizeKey& size : kSizes) {
    if (!seen.contains(std::string(size.key))) missing.emplace_back(size.key);
  }
  for (const NumberKey& number : kNumbers) {
    if (number.required && !seen.contains(std::string(number.key)))
      missing.emplace_back(number.key);
  }
  if (!missing.empty()) throw Error("{}: missing {}", file, joined(missing, ", "));
}

YAML::Node load_yaml(const std::filesystem::path& path) {
  const std::string text = read_file(path, kMaxYamlBytes);
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& exception) {
    throw Error("{}:{}: not YAML: {}", path.string(), exception.mark.line + 1, exception.msg);
  }
}

}  // namespace

CameraModel read_camera_yaml(const std::filesystem::path& path) {
  const YAML::Node root = load_yaml(path);
  if (!root.IsMap()) {
    throw Error("{}: not a camera, expected lines such as 'fx: 535.4'", path.string());
  }
  CameraModel camera;
  camera.name = path.stem().string();
  const std::vector<std::string> known = known_keys();
  std::set<std::string> seen;
  for (const auto& entry : root) {
    const std::string place = fmt::format("{}:{}", path.string(), entry.first.Mark().line + 1);
    if (!entry.first.IsScalar() || !entry.second.IsScalar()) {
      throw Error("{}: expected one value for each key, such as 'fx: 535.4'", place);
    }
    const std::string& key = entry.first.Scalar();
    if (std::ranges::find(known, key) == known.end()) {
      throw Error("{}: unknown key '{}': {}", place, key, name_hint(key, known));
    }
    if (!seen.insert(key).second) throw Error("{}: {} is given twice", place, key);
    set_value(camera, key, entry.second.Scalar(), place);
  }
  require_keys(seen, path.string());
  check_camera(camera, path.string());
  return camera;
}

CameraModel camera_by_name(const std::string& name_or_file) {
  const bool is_file =
      name_or_file.find('/') != std::string::npos || name_or_file.ends_with(".yaml");
  return is_file ? read_camera_yaml(name_or_file) : builtin_camera(name_or_file);
}

std::string format_camera_yaml(const CameraModel& camera) {
  YAML::Emitter name;
  name << YAML::DoubleQuoted << camera.name;
  std::string text = fmt::format("name: {}\n", name.c_str());
  for (const SizeKey& size : kSizes) text += fmt::format("{}: {}\n", size.key, camera.*size.member);
  for (const NumberKey& entry : kNumbers) {
    text += fmt::format("{}: {}\n", entry.key, camera.*entry.member);
  }
  return text;
}

CameraModel read_truth_camera(const std::filesystem::path& objects_json) {
  const std::string place = objects_json.string();
  const nlohmann::json root =
      nlohmann::json::parse(read_file(objects_json, kMaxTruthBytes), nullptr, false);
  if (root.is_discarded()) throw Error("{}: not JSON", place);
  if (!root.is_object() || !root.contains("camera") || !root["camera"].is_object()) {
    throw Error("{}: no object 'camera' in it", place);
  }
  CameraModel camera;
  camera.name = "truth";
  std::set<std::string> seen;
  for (const auto& [key, value] : root["camera"].items()) {
    seen.insert(key);
    const bool is_name = key == "name";
    if (is_name ? value.is_string() : value.is_number()) {
      set_value(camera, key, is_name ? value.get<std::string>() : value.dump(), place);
    }
  }
  require_keys(seen, place);
  check_camera(camera, place);
  return camera;
}

void check_camera(const CameraModel& camera, const std::string& place) {
  for (const SizeKey& size : kSizes) {
    const int value = camera.*size.member;
    if (value < 1 || value > kMaxImageSidePx) {
      throw Error("{}: {} is {}, expected 1 to {} pixels", place, size.key, value, kMaxImageSidePx);
    }
  }
  for (const NumberKey& entry : kNumbers) {
    const double value = camera.*entry.member;
    if (!std::isfinite(value))
      throw Error("{}: {} is {}, expected a number", place, entry.key, value);
    const bool positive = entry.key == "fx" || entry.key == "fy" || entry.key == "depth_factor";
    if (positive && value <= 0.0) {
      throw Error("{}: {} is {}, expected a positive number", place, entry.key, value);
    }
    if (entry.key == "readout_s" && (value < 0.0 || value > 1.0)) {
      throw Error("{}: {} is {}, expected 0 to 1 seconds", place, entry.key, value);
    }
  }
}

}  // namespace stillmap
