// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "stillmap/geometry/camera.hpp"
#include "tests/support/bags/bag_writer.hpp"

namespace stillmap {

/// `pixels` are stored without gaps between rows.
template <class Pixels>
[[nodiscard]] ImageToWrite to_write(const Pixels& pixels, const std::string& encoding) {
  ImageToWrite image;
  image.width_px = static_cast<std::uint32_t>(pixels.cols);
  image.height_px = static_cast<std::uint32_t>(pixels.rows);
  image.encoding = encoding;
  image.row_bytes = static_cast<std::uint32_t>(pixels.cols * pixels.elemSize());
  image.bytes.assign(pixels.data, pixels.data + pixels.total() * pixels.elemSize());
  return image;
}

/// The calibration of a camera without distortion.
[[nodiscard]] inline InfoToWrite to_write(const CameraModel& camera) {
  InfoToWrite info;
  info.width_px = static_cast<std::uint32_t>(camera.width_px);
  info.height_px = static_cast<std::uint32_t>(camera.height_px);
  info.model = "plumb_bob";
  info.D = {0, 0, 0, 0, 0};
  info.K = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  info.P = {camera.fx, 0, camera.cx, 0, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0};
  return info;
}

}  // namespace stillmap
