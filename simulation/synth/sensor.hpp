// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "simulation/render/renderer.hpp"
#include "stillmap/core/ids.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// What a real sensor of the first Kinect's kind does to perfect images. Its depth comes from the
/// disparity d = fx * baseline / z between a projector and a camera, counted in pixels of an image
/// 640 wide whatever the size of the rendered one.
struct SensorOptions {
  double exposure_s = 0.012;   ///< while which the image moves; 0 for no motion blur
  bool exposure_drift = true;  ///< slow changes of brightness and of the colour of white
  bool color_noise = true;
  bool depth_noise = true;  ///< noise and quantisation of the disparity
  bool depth_holes = true;  ///< shadows of the projector, grazing surfaces, range

  double color_sigma = 2.0;             ///< of each channel, of 255
  double drift_share = 0.06;            ///< of brightness, at most; of each channel half of that
  double depth_sigma_at_1m_m = 0.0015;  ///< of depth at 1 m; grows with the square of depth
  double disparity_step_px = 0.125;     ///< quantisation
  double baseline_m = 0.075;            ///< from the camera to the projector
  double min_depth_m = 0.5;             ///< nothing nearer is measured
  double max_depth_m = 8.0;             ///< nor farther
  double max_incidence_deg = 80.0;      ///< surfaces turned away farther than that are missing
  double edge_dropout = 0.5;            ///< share of the pixels along depth edges that are missing

  /// No effects at all: the images pass unchanged.
  [[nodiscard]] static SensorOptions clean() {
    return {.exposure_s = 0,
            .exposure_drift = false,
            .color_noise = false,
            .depth_noise = false,
            .depth_holes = false};
  }
};

/// An image with depth, as a sensor gives it.
struct RgbdImage {
  ColorImage color;
  DepthImage depth;
};

/// The gain of red, green and blue at a frame, about 1; smooth over time, a period being seconds.
[[nodiscard]] std::array<float, 3> exposure_gains(double share, std::uint32_t seed, FrameId frame);

/// The images as the sensor would give them; motion blur is the renderer's. A function of its
/// arguments: the same seed and frame give the same noise.
[[nodiscard]] RgbdImage apply_sensor(const RenderedImage& perfect,
                                     const CameraModel& camera,
                                     const SensorOptions& options,
                                     std::uint32_t seed,
                                     FrameId frame);

}  // namespace stillmap
