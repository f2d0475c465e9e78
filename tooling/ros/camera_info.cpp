// SPDX-License-Identifier: Apache-2.0
#include "tooling/ros/camera_info.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "stillmap/sensor/camera_formats.hpp"
#include "stillmap/sensor/camera_io.hpp"

namespace stillmap {
namespace {

std::string listed(std::span<const double> numbers) {
  std::string text;
  for (const double number : numbers) text += fmt::format("{}{}", text.empty() ? "" : ", ", number);
  return text;
}

/// The message as ROS prints it, so that one reader knows the lenses of files and of bags. `k` is
/// the matrix of the images; rectified images have no distortion.
std::string printed(const RosCameraInfo& info, const std::array<double, 9>& k, bool rectified) {
  constexpr std::uint32_t kMostPx = 1U << 20U;
  std::string text = fmt::format("width: {}\nheight: {}\nK: [{}]\n",
                                 std::min(info.width_px, kMostPx),
                                 std::min(info.height_px, kMostPx),
                                 listed(k));
  const auto is_zero = [](double number) { return number == 0; };
  if (rectified || std::ranges::all_of(info.distortion, is_zero)) return text;
  const bool of_realsense = info.distortion_model == "Brown Conrady";
  return text + fmt::format("distortion_model: '{}'\nD: [{}]\n",
                            of_realsense ? "plumb_bob" : info.distortion_model,
                            listed(info.distortion));
}

}  // namespace

CameraModel camera_of_info(const RosCameraInfo& info, bool rectified, const std::string& place) {
  std::array<double, 9> k = info.intrinsics;
  const std::array<double, 12>& p = info.projection;
  if (rectified) k = {p[0], p[1], p[2], p[4], p[5], p[6], p[8], p[9], p[10]};
  if (k[0] == 0 && k[4] == 0) throw Error("{}: the camera is not calibrated", place);
  CameraModel camera =
      read_foreign_camera(CameraValues::parse(printed(info, k, rectified), place)).value();
  camera.name = place;
  camera.depth_factor = 1000;
  camera.depth_factor_given = true;
  check_camera(camera, place);
  return camera;
}

bool looks_registered(const RosCameraInfo& depth, const CameraModel& color) {
  constexpr double kSamePx = 2;
  return std::abs(depth.intrinsics[0] - color.fx) < kSamePx &&
         std::abs(depth.intrinsics[2] - color.cx) < kSamePx;
}

}  // namespace stillmap
