// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "simulation/render/renderer.hpp"
#include "stillmap/core/ids.hpp"
#include "stillmap/core/images.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// The faults of a sensor like the first Kinect. Depth comes from the disparity d = fx * baseline /
/// z between a projector and a camera, in pixels of an image 640 wide, whatever the size of the
/// rendered image.
struct SensorOptions {
  double exposure_s = 0.012;   ///< duration of motion blur; 0 for none
  bool exposure_drift = true;  ///< slow changes of brightness and white balance
  bool color_noise = true;
  bool depth_noise = true;  ///< noise and quantisation of the disparity
  bool depth_holes = true;  ///< shadows of the projector, grazing surfaces, range

  double color_sigma = 2.0;   ///< standard deviation of each channel, of 255
  double drift_share = 0.06;  ///< greatest change of brightness; half of it for each channel
  /// standard deviation of depth at 1 m; grows with depth squared
  double depth_sigma_at_1m_m = 0.0015;
  double disparity_step_px = 0.125;  ///< quantisation
  double baseline_m = 0.075;         ///< from the camera to the projector
  double min_depth_m = 0.5;          ///< least measured depth
  double max_depth_m = 8.0;          ///< greatest measured depth
  double max_incidence_deg = 80.0;   ///< greatest angle of incidence with depth
  double edge_dropout = 0.5;         ///< share of pixels without depth along depth edges

  /// No faults: the images stay unchanged.
  [[nodiscard]] static SensorOptions clean() {
    return {.exposure_s = 0,
            .exposure_drift = false,
            .color_noise = false,
            .depth_noise = false,
            .depth_holes = false};
  }
};

/// A colour image and depth image of the sensor.
struct RgbdImage {
  ColorImage color;
  DepthImage depth;
};

/// The gains of red, green and blue in a frame, about 1 and smooth over time, with periods of
/// seconds.
[[nodiscard]] std::array<float, 3> exposure_gains(double share, std::uint32_t seed, FrameId frame);

/// The images with the faults of the sensor. The renderer adds motion blur. Depends on the
/// arguments alone: the same seed and frame give the same noise.
[[nodiscard]] RgbdImage apply_sensor(const RenderedImage& perfect,
                                     const CameraModel& camera,
                                     const SensorOptions& options,
                                     std::uint32_t seed,
                                     FrameId frame);

/// The colour image of a second camera of this kind beside the first one: its gains are those of
/// the first, its noise is its own.
[[nodiscard]] ColorImage apply_second_sensor(const ColorImage& perfect,
                                             const SensorOptions& options,
                                             std::uint32_t seed,
                                             FrameId frame);

}  // namespace stillmap
