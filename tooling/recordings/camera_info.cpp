// SPDX-License-Identifier: Apache-2.0
#include "tooling/recordings/camera_info.hpp"

#include <algorithm>

#include "stillmap/core/error.hpp"
#include "stillmap/sensor/camera_io.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kBrownParameters = 5;

bool all_zero(const std::vector<double>& numbers, std::size_t from) {
  return std::ranges::all_of(
      numbers.begin() + static_cast<std::ptrdiff_t>(std::min(from, numbers.size())),
      numbers.end(),
      [](double number) { return number == 0; });
}

bool is_brown(const std::string& model) {
  return model == "plumb_bob" || model == "rational_polynomial" || model == "Brown Conrady";
}

}  // namespace

CameraModel camera_of_info(const RosCameraInfo& info, bool rectified, const std::string& place) {
  constexpr std::uint32_t kMostPx = 1U << 20U;
  CameraModel camera;
  camera.name = place;
  camera.width_px = static_cast<int>(std::min(info.width_px, kMostPx));
  camera.height_px = static_cast<int>(std::min(info.height_px, kMostPx));
  camera.depth_factor = 1000;
  if (rectified) {
    camera.fx = info.projection[0];
    camera.fy = info.projection[5];
    camera.cx = info.projection[2];
    camera.cy = info.projection[6];
  } else {
    camera.fx = info.intrinsics[0];
    camera.fy = info.intrinsics[4];
    camera.cx = info.intrinsics[2];
    camera.cy = info.intrinsics[5];
  }
  if (camera.fx == 0 && camera.fy == 0) throw Error("{}: the camera is not calibrated", place);
  const std::vector<double>& d = info.distortion;
  if (!rectified && !all_zero(d, 0)) {
    if (!is_brown(info.distortion_model) || !all_zero(d, kBrownParameters)) {
      throw Error("{}: distortion '{}' with {} parameters, expected plumb_bob with 5",
                  place,
                  info.distortion_model,
                  d.size());
    }
    const auto parameter = [&](std::size_t i) { return i < d.size() ? d[i] : 0.0; };
    camera.k1 = parameter(0);
    camera.k2 = parameter(1);
    camera.p1 = parameter(2);
    camera.p2 = parameter(3);
    camera.k3 = parameter(4);
  }
  check_camera(camera, place);
  return camera;
}

}  // namespace stillmap
