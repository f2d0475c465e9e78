// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/intrinsic_files.hpp"

#include <array>
#include <vector>

#include <nlohmann/json.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/io/text_file.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/sensor/number_text.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20U;

double number(const nlohmann::json& root, const char* key, const std::string& place) {
  if (!root.contains(key) || !root[key].is_number()) {
    throw Error("{}: '{}' is missing or no number", place, key);
  }
  return root[key].get<double>();
}

int whole(const nlohmann::json& root, const char* key, const std::string& place) {
  const double value = number(root, key, place);
  if (value < 1 || value > 1e5) throw Error("{}: '{}' is {}, expected pixels", place, key, value);
  return static_cast<int>(value);
}

}  // namespace

std::optional<CameraModel> read_intrinsic_json(const std::filesystem::path& path) {
  const std::string place = path.string();
  const nlohmann::json root = nlohmann::json::parse(read_text(path, kMaxBytes), nullptr, false);
  if (!root.is_object() || !root.contains("intrinsic_matrix")) return std::nullopt;
  const nlohmann::json& matrix = root["intrinsic_matrix"];
  const auto is_number = [](const nlohmann::json& entry) { return entry.is_number(); };
  if (!matrix.is_array() || matrix.size() != 9 ||
      !std::all_of(matrix.begin(), matrix.end(), is_number)) {
    throw Error("{}: 'intrinsic_matrix' is no list of 9 numbers", place);
  }
  CameraModel camera;
  camera.name = path.stem().string();
  camera.width_px = whole(root, "width", place);
  camera.height_px = whole(root, "height", place);
  camera.fx = matrix[0].get<double>();
  camera.fy = matrix[4].get<double>();
  camera.cx = matrix[6].get<double>();
  camera.cy = matrix[7].get<double>();
  camera.depth_factor = root.contains("depth_scale") ? number(root, "depth_scale", place) : 1000;
  check_camera(camera, place);
  return camera;
}

CameraModel read_intrinsic_text(const std::filesystem::path& path, cv::Size size) {
  const std::string place = path.string();
  const std::vector<double> numbers = numbers_in(read_text(path, kMaxBytes), place);
  if (numbers.size() != 9 && numbers.size() != 16) {
    throw Error("{}: {} numbers, expected a matrix of 3x3 or 4x4", place, numbers.size());
  }
  const std::size_t row = numbers.size() == 9 ? 3 : 4;
  CameraModel camera;
  camera.name = path.stem().string();
  camera.width_px = size.width;
  camera.height_px = size.height;
  camera.fx = numbers[0];
  camera.fy = numbers[row + 1];
  camera.cx = numbers[2];
  camera.cy = numbers[row + 2];
  camera.depth_factor = 1000;
  check_camera(camera, place);
  return camera;
}

}  // namespace stillmap
