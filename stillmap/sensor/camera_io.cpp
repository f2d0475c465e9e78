// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/camera_io.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>
#include <yaml-cpp/yaml.h>

#include "stillmap/core/error.hpp"
#include "stillmap/core/nearest_name.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/geometry/se3.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/png_codec.hpp"
#include "stillmap/sensor/camera_formats.hpp"
#include "stillmap/sensor/camera_values.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMaxTruthBytes = std::size_t{1} << 30U;
constexpr double kRotationTolerance = 1e-4;  // files have a few decimals

struct NumberKey {
  std::string_view key;
  double CameraModel::*member;
  bool required;
};

constexpr std::array<NumberKey, 12> kLensNumbers = {{{"fx", &CameraModel::fx, true},
                                                     {"fy", &CameraModel::fy, true},
                                                     {"cx", &CameraModel::cx, true},
                                                     {"cy", &CameraModel::cy, true},
                                                     {"k1", &CameraModel::k1, false},
                                                     {"k2", &CameraModel::k2, false},
                                                     {"p1", &CameraModel::p1, false},
                                                     {"p2", &CameraModel::p2, false},
                                                     {"k3", &CameraModel::k3, false},
                                                     {"k4", &CameraModel::k4, false},
                                                     {"k5", &CameraModel::k5, false},
                                                     {"k6", &CameraModel::k6, false}}};

struct SizeKey {
  std::string_view key;
  int CameraModel::*member;
};

constexpr std::array<SizeKey, 2> kSizes = {
    {{"width", &CameraModel::width_px}, {"height", &CameraModel::height_px}}};

constexpr std::string_view kBrownConradyName = "brown_conrady";
constexpr std::string_view kFisheyeName = "fisheye";

// The keys of a lens that begin with `prefix`.
std::vector<std::string> lens_keys(const std::string& prefix, bool required_only) {
  std::vector<std::string> keys;
  for (const SizeKey& size : kSizes) keys.push_back(prefix + std::string(size.key));
  for (const NumberKey& number : kLensNumbers) {
    if (number.required || !required_only) keys.push_back(prefix + std::string(number.key));
  }
  if (!required_only) keys.push_back(prefix + "lens");
  return keys;
}

std::vector<std::string> known_keys() {
  std::vector<std::string> keys = lens_keys("", false);
  for (const char* key : {"name", "depth_factor", "readout_s"}) keys.emplace_back(key);
  std::ranges::copy(lens_keys("depth.", false), std::back_inserter(keys));
  for (const char* key : {"depth.rotation", "depth.translation"}) keys.emplace_back(key);
  return keys;
}

LensModel lens_named(const CameraValues& values, const std::string& key) {
  const std::string& name = values.text(key);
  if (name == kBrownConradyName) return LensModel::kBrownConrady;
  if (name == kFisheyeName) return LensModel::kFisheye;
  throw Error("{}: {} is '{}', expected {} or {}",
              values.place(key),
              key,
              name,
              kBrownConradyName,
              kFisheyeName);
}

void read_lens(const CameraValues& values, const std::string& prefix, CameraModel& camera) {
  values.require(lens_keys(prefix, true));
  for (const SizeKey& size : kSizes) {
    camera.*size.member = values.whole(prefix + std::string(size.key));
  }
  for (const NumberKey& number : kLensNumbers) {
    const std::string key = prefix + std::string(number.key);
    if (values.has(key)) camera.*number.member = values.number(key);
  }
  if (values.has(prefix + "lens")) camera.lens = lens_named(values, prefix + "lens");
}

Eigen::Matrix3d read_rotation(const CameraValues& values, const std::string& key) {
  const std::vector<double> n = values.numbers(key);
  if (n.size() == 4) {
    const Eigen::Quaterniond q(n[3], n[0], n[1], n[2]);
    if (std::abs(q.norm() - 1) < kRotationTolerance) return q.normalized().toRotationMatrix();
  } else if (n.size() == 9) {
    Eigen::Matrix3d R;
    R << n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8];
    const double error = (R * R.transpose() - Eigen::Matrix3d::Identity()).norm();
    if (error < kRotationTolerance && R.determinant() > 0) {
      return error < 1e-12 ? R : Eigen::Quaterniond(R).normalized().toRotationMatrix();
    }
  }
  throw Error("{}: {}: expected a quaternion [x, y, z, w] or the 9 numbers of a rotation, by rows",
              values.place(key),
              key);
}

std::shared_ptr<const DepthCamera> read_depth_camera(const CameraValues& values) {
  auto depth = std::make_shared<DepthCamera>();
  read_lens(values, "depth.", depth->camera);
  if (values.has("depth.rotation")) {
    depth->T_color_depth.linear() = read_rotation(values, "depth.rotation");
  }
  if (values.has("depth.translation")) {
    const std::vector<double> t = values.numbers("depth.translation");
    if (t.size() != 3) {
      throw Error("{}: depth.translation has {} numbers, expected 3, in metres",
                  values.place("depth.translation"),
                  t.size());
    }
    depth->T_color_depth.translation() = Eigen::Vector3d(t[0], t[1], t[2]);
  }
  return depth;
}

CameraModel read_own(const CameraValues& values) {
  CameraModel camera;
  read_lens(values, "", camera);
  if (values.has("name")) camera.name = values.text("name");
  camera.depth_factor_given = values.has("depth_factor");
  if (camera.depth_factor_given) camera.depth_factor = values.number("depth_factor");
  if (values.has("readout_s")) camera.readout_s = values.number("readout_s");
  if (values.has_prefix("depth.")) camera.depth_camera = read_depth_camera(values);
  return camera;
}

// A key that nobody reads would be a silent mistake.
void check_keys(const CameraValues& values) {
  const std::vector<std::string> known = known_keys();
  for (const CameraValue& value : values.all()) {
    if (std::ranges::find(known, value.key) != known.end()) continue;
    throw Error("{}: unknown key '{}': {}",
                values.place(value.key),
                value.key,
                name_hint(value.key, known));
  }
}

void check_lens(const CameraModel& camera, const std::string& place) {
  for (const SizeKey& size : kSizes) {
    const int value = camera.*size.member;
    if (value < 1 || value > kMaxImageSidePx) {
      throw Error("{}: {} is {}, expected 1 to {} pixels", place, size.key, value, kMaxImageSidePx);
    }
  }
  for (const NumberKey& entry : kLensNumbers) {
    const double value = camera.*entry.member;
    if (!std::isfinite(value)) {
      throw Error("{}: {} is {}, expected a number", place, entry.key, value);
    }
    if ((entry.key == "fx" || entry.key == "fy") && value <= 0.0) {
      throw Error("{}: {} is {}, expected a positive number", place, entry.key, value);
    }
  }
  const bool others = camera.p1 != 0 || camera.p2 != 0 || camera.k5 != 0 || camera.k6 != 0;
  if (camera.lens == LensModel::kFisheye && others) {
    throw Error("{}: a fish-eye has k1 to k4, expected p1, p2, k5 and k6 to be 0", place);
  }
}

std::string format_lens(const CameraModel& camera, const std::string& indent) {
  std::string text;
  for (const SizeKey& size : kSizes) {
    text += fmt::format("{}{}: {}\n", indent, size.key, camera.*size.member);
  }
  for (const NumberKey& entry : kLensNumbers) {
    const bool wide = entry.key == "k4" || entry.key == "k5" || entry.key == "k6";
    if (wide && camera.*entry.member == 0) continue;
    text += fmt::format("{}{}: {}\n", indent, entry.key, camera.*entry.member);
  }
  if (camera.lens == LensModel::kFisheye) text += fmt::format("{}lens: {}\n", indent, kFisheyeName);
  return text;
}

std::string format_depth_camera(const DepthCamera& depth) {
  const Eigen::Matrix3d R = depth.T_color_depth.linear();
  const Eigen::Vector3d t = depth.T_color_depth.translation();
  return "depth:\n" + format_lens(depth.camera, "  ") +
         fmt::format("  rotation: [{}, {}, {}, {}, {}, {}, {}, {}, {}]\n",
                     R(0, 0),
                     R(0, 1),
                     R(0, 2),
                     R(1, 0),
                     R(1, 1),
                     R(1, 2),
                     R(2, 0),
                     R(2, 1),
                     R(2, 2)) +
         fmt::format("  translation: [{}, {}, {}]\n", t.x(), t.y(), t.z());
}

}  // namespace

CameraModel read_camera_yaml(const std::filesystem::path& path) {
  const CameraValues values = CameraValues::read(path);
  std::optional<CameraModel> camera = read_foreign_camera(values);
  if (!camera) {
    check_keys(values);
    camera = read_own(values);
  }
  if (camera->name.empty()) camera->name = path.stem().string();
  check_camera(*camera, path.string());
  return *camera;
}

CameraModel camera_by_name(const std::string& name_or_file) {
  const std::vector<std::string> builtin = builtin_camera_names();
  if (std::ranges::find(builtin, name_or_file) != builtin.end()) {
    return builtin_camera(name_or_file);
  }
  const auto ends_so = [&](const char* ending) { return name_or_file.ends_with(ending); };
  const bool is_file = name_or_file.find('/') != std::string::npos || ends_so(".yaml") ||
                       ends_so(".yml") || ends_so(".json") || path_exists(name_or_file);
  return is_file ? read_camera_yaml(name_or_file) : builtin_camera(name_or_file);
}

std::string format_camera_yaml(const CameraModel& camera) {
  YAML::Emitter name;
  name << YAML::DoubleQuoted << camera.name;
  std::string text = fmt::format("name: {}\n", name.c_str()) + format_lens(camera, "");
  if (camera.depth_factor_given) text += fmt::format("depth_factor: {}\n", camera.depth_factor);
  text += fmt::format("readout_s: {}\n", camera.readout_s);
  if (camera.depth_camera) text += format_depth_camera(*camera.depth_camera);
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
  CameraModel camera = read_own(CameraValues::parse(root["camera"].dump(), place));
  if (camera.name.empty()) camera.name = "truth";
  check_camera(camera, place);
  return camera;
}

void check_camera(const CameraModel& camera, const std::string& place) {
  check_lens(camera, place);
  if (!(std::isfinite(camera.depth_factor) && camera.depth_factor > 0.0)) {
    throw Error("{}: depth_factor is {}, expected a positive number", place, camera.depth_factor);
  }
  if (!(camera.readout_s >= 0.0 && camera.readout_s <= 1.0)) {
    throw Error("{}: readout_s is {}, expected 0 to 1 seconds", place, camera.readout_s);
  }
  if (camera.depth_camera) check_lens(camera.depth_camera->camera, place + ": depth");
}

}  // namespace stillmap
