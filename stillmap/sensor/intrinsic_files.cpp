// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/intrinsic_files.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/io/text_file.hpp"
#include "stillmap/sensor/camera_formats.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/sensor/number_text.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20U;

}  // namespace

std::optional<CameraModel> read_intrinsic_json(const std::filesystem::path& path) {
  const std::string place = path.string();
  std::string text = read_text(path, kMaxBytes);
  const nlohmann::json root = nlohmann::json::parse(text, nullptr, false);
  if (!root.is_object() || !root.contains("intrinsic_matrix")) return std::nullopt;
  const nlohmann::json& matrix = root["intrinsic_matrix"];
  const auto is_number = [](const nlohmann::json& entry) { return entry.is_number(); };
  if (!matrix.is_array() || matrix.size() != 9 ||
      !std::all_of(matrix.begin(), matrix.end(), is_number)) {
    throw Error("{}: 'intrinsic_matrix' is no list of 9 numbers", place);
  }
  CameraModel camera = read_foreign_camera(CameraValues::parse(std::move(text), place)).value();
  camera.name = path.stem().string();
  if (!camera.depth_factor_given) camera.depth_factor = 1000;
  camera.depth_factor_given = true;
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
