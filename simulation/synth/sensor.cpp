// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/sensor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "simulation/scene/hash_random.hpp"

namespace stillmap {
namespace {

// Each pixel has its own random key: the order of evaluation does not matter.
enum class Effect : std::uint64_t { kColor = 1, kDepth = 2, kEdge = 3, kDrift = 4, kSecond = 5 };

std::uint64_t effect_key(Effect effect, std::uint32_t seed, FrameId frame) {
  const std::uint64_t run = (std::uint64_t{seed} << 32U) | frame.value;
  return mix_bits(mix_bits(run) + static_cast<std::uint64_t>(effect));
}

using Gains = std::array<float, 3>;

// Gain and noise in one pass.
cv::Mat3b recorded_color(const cv::Mat3b& perfect,
                         const Gains& gains,
                         float sigma,
                         std::uint64_t key) {
  cv::Mat3b recorded(perfect.size());
  for (int y = 0; y < perfect.rows; ++y) {
    const cv::Vec3b* in = perfect.ptr<cv::Vec3b>(y);
    cv::Vec3b* out = recorded.ptr<cv::Vec3b>(y);
    for (int x = 0; x < perfect.cols; ++x) {
      for (int i = 0; i < 3; ++i) {
        const float noise = sigma > 0 ? sigma * hash_normal(key++) : 0.F;
        const float value = gains[static_cast<std::size_t>(i)] * static_cast<float>(in[x][i]);
        out[x][i] = cv::saturate_cast<std::uint8_t>(value + noise);
      }
    }
  }
  return recorded;
}

struct DepthSensor {
  const SensorOptions& options;
  double steepest_slope;       // of depth from pixel to pixel, as a share of the depth
  double disparity_640_scale;  // disparity = this / z, in pixels of an image 640 wide
  double disparity_scale;      // the same in pixels of the image at hand

  DepthSensor(const SensorOptions& o, const CameraModel& camera)
      : options(o),
        steepest_slope(std::tan(o.max_incidence_deg * std::numbers::pi / 180.0) / camera.fx),
        disparity_640_scale(camera.fx * 640.0 / camera.width_px * o.baseline_m),
        disparity_scale(camera.fx * o.baseline_m) {}
};

// True where the projector's light does not reach: some nearer surface to the right of the pixel
// covers the same column of the projector, which stands to the right of the camera.
cv::Mat1b shadows(const cv::Mat1f& depth, const DepthSensor& sensor) {
  cv::Mat1b shadow(depth.size(), std::uint8_t{0});
  for (int y = 0; y < depth.rows; ++y) {
    double covered_from = std::numeric_limits<double>::infinity();
    for (int x = depth.cols - 1; x >= 0; --x) {
      if (depth(y, x) <= 0.F) continue;
      const double column = x - sensor.disparity_scale / depth(y, x);
      shadow(y, x) = column >= covered_from ? 1 : 0;
      covered_from = std::min(covered_from, column);
    }
  }
  return shadow;
}

// The surface at a pixel, from its neighbours.
struct Relief {
  bool grazing;
  bool at_edge;
};

Relief relief_at(const cv::Mat1f& depth, int x, int y, const DepthSensor& sensor) {
  const float z = depth(y, x);
  const double steepest = sensor.steepest_slope * z;
  const auto step_to = [&](int dx, int dy) {
    const int nx = std::clamp(x + dx, 0, depth.cols - 1),
              ny = std::clamp(y + dy, 0, depth.rows - 1);
    return static_cast<double>(std::abs(depth(ny, nx) - z));
  };
  const double left = step_to(-1, 0), right = step_to(1, 0), up = step_to(0, -1),
               down = step_to(0, 1);
  // A steep surface falls off on both sides; next to an edge the other side is flat.
  const bool grazing = std::min(left, right) > steepest || std::min(up, down) > steepest;
  const double highest = std::max({left, right, up, down});
  return {grazing, highest > std::max(steepest, 0.02 * z)};
}

cv::Mat1f with_holes(const cv::Mat1f& perfect, const DepthSensor& sensor, std::uint64_t key) {
  const cv::Mat1b shadow = shadows(perfect, sensor);
  cv::Mat1f depth = perfect.clone();
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x, ++key) {
      const float z = perfect(y, x);
      if (z <= 0.F) continue;
      const Relief relief = relief_at(perfect, x, y, sensor);
      const bool dropped =
          relief.at_edge && hash_uniform(key) < static_cast<float>(sensor.options.edge_dropout);
      const bool out_of_range = z < sensor.options.min_depth_m || z > sensor.options.max_depth_m;
      if (shadow(y, x) != 0 || relief.grazing || dropped || out_of_range) depth(y, x) = 0.F;
    }
  }
  return depth;
}

// sigma(z) = s z^2 in depth is one sigma of disparity at every depth.
cv::Mat1f noisy_depth(const cv::Mat1f& perfect, const DepthSensor& sensor, std::uint64_t key) {
  const double sigma_px = sensor.disparity_640_scale * sensor.options.depth_sigma_at_1m_m;
  const double step_px = sensor.options.disparity_step_px;
  cv::Mat1f depth(perfect.size());
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x, ++key) {
      const float z = perfect(y, x);
      depth(y, x) = 0.F;
      if (z <= 0.F) continue;
      const double noisy = sensor.disparity_640_scale / z + sigma_px * hash_normal(key);
      const double disparity = step_px > 0 ? step_px * std::round(noisy / step_px) : noisy;
      if (disparity <= 0) continue;
      depth(y, x) = static_cast<float>(sensor.disparity_640_scale / disparity);
    }
  }
  return depth;
}

}  // namespace

std::array<float, 3> exposure_gains(double share, std::uint32_t seed, FrameId frame) {
  constexpr double kFramesPerTurn = 230.0;
  const auto wave = [&](std::uint64_t part, double speed) {
    const double phase = hash_uniform(effect_key(Effect::kDrift, seed, FrameId(0)) + part);
    return std::sin(2.0 * std::numbers::pi * (speed * frame.value / kFramesPerTurn + phase));
  };
  const double brightness = share * (0.7 * wave(0, 1.0) + 0.3 * wave(1, 2.3));
  Gains gains;
  for (std::size_t i = 0; i < 3; ++i) {
    gains[i] = static_cast<float>(1.0 + brightness + 0.5 * share * wave(2 + i, 0.6));
  }
  return gains;
}

namespace {

ColorImage measured_color(const ColorImage& perfect,
                          const SensorOptions& options,
                          Effect noise,
                          std::uint32_t seed,
                          FrameId frame) {
  if (!options.exposure_drift && !options.color_noise) return perfect;
  const Gains gains = options.exposure_drift ? exposure_gains(options.drift_share, seed, frame)
                                             : Gains{1.F, 1.F, 1.F};
  const float sigma = options.color_noise ? static_cast<float>(options.color_sigma) : 0.F;
  return ColorImage(recorded_color(perfect.mat, gains, sigma, effect_key(noise, seed, frame)));
}

}  // namespace

RgbdImage apply_sensor(const RenderedImage& perfect,
                       const CameraModel& camera,
                       const SensorOptions& options,
                       std::uint32_t seed,
                       FrameId frame) {
  RgbdImage measured{measured_color(perfect.color, options, Effect::kColor, seed, frame),
                     perfect.depth};
  const DepthSensor sensor(options, camera);
  if (options.depth_holes) {
    measured.depth.mat =
        with_holes(measured.depth.mat, sensor, effect_key(Effect::kEdge, seed, frame));
  }
  if (options.depth_noise) {
    measured.depth.mat =
        noisy_depth(measured.depth.mat, sensor, effect_key(Effect::kDepth, seed, frame));
  }
  return measured;
}

ColorImage apply_second_sensor(const ColorImage& perfect,
                               const SensorOptions& options,
                               std::uint32_t seed,
                               FrameId frame) {
  return measured_color(perfect, options, Effect::kSecond, seed, frame);
}

}  // namespace stillmap
