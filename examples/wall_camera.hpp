// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/geometry/camera.hpp"

/// Stands in for a camera's driver: it slides along a painted wall with a step in it.
class WallCamera {
 public:
  WallCamera() {
    cv::Mat3b tiles(24, 60);
    cv::RNG(7).fill(tiles, cv::RNG::UNIFORM, 0, 256);
    cv::resize(tiles, wall_, {}, 10, 10, cv::INTER_NEAREST);
  }

  [[nodiscard]] static stillmap::CameraModel model() {
    stillmap::CameraModel camera;
    camera.name = "wall";
    camera.width_px = 320;
    camera.height_px = 240;
    camera.fx = camera.fy = 300;
    camera.cx = 160;
    camera.cy = 120;
    return camera;
  }

  /// The images of the next moment, a thirtieth of a second later and 1 cm farther right.
  [[nodiscard]] stillmap::RgbdFrame grab() {
    const int k = frame_++;
    const cv::Mat3b color = wall_(cv::Rect(2 * k, 0, 320, 240)).clone();
    return stillmap::make_frame(
        k / 30.0, stillmap::ColorImage(color), stillmap::DepthImage(cv::Mat1f(240, 320, 1.5F)));
  }

 private:
  cv::Mat3b wall_;
  int frame_ = 0;
};
