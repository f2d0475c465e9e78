// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/sensor.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "simulation/synth/sequence.hpp"

namespace stillmap {
namespace {

const CameraModel kCamera = builtin_camera("tum_fr3");  // fx 535.4: disparity 40.155 px at 1 m

RenderedImage flat(float z, const cv::Vec3b& color = {128, 128, 128}) {
  return {ColorImage(cv::Mat3b(480, 640, color)), DepthImage(cv::Mat1f(480, 640, z)), {}};
}

SensorOptions only_depth_noise() {
  SensorOptions options = SensorOptions::clean();
  options.depth_noise = true;
  return options;
}

SensorOptions only_holes() {
  SensorOptions options = SensorOptions::clean();
  options.depth_holes = true;
  options.edge_dropout = 0;
  return options;
}

struct Spread {
  double mean = 0, sigma = 0;
};

template <class Image>
Spread spread_of(const Image& values) {
  double sum = 0, squares = 0;
  for (const auto value : values) {
    sum += value;
    squares += static_cast<double>(value) * value;
  }
  const double n = static_cast<double>(values.total());
  return {sum / n, std::sqrt(squares / n - sum / n * (sum / n))};
}

TEST(Sensor, CleanChangesNothing) {
  const RenderedImage perfect = flat(9.F);
  const RgbdImage seen = apply_sensor(perfect, kCamera, SensorOptions::clean(), 1, FrameId(0));
  EXPECT_EQ(cv::norm(seen.depth.mat, perfect.depth.mat, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(seen.color.mat, perfect.color.mat, cv::NORM_INF), 0);
}

TEST(Sensor, DepthNoiseGrowsWithTheSquareOfDepth) {
  SensorOptions options = only_depth_noise();
  options.disparity_step_px = 0;
  for (const float z : {1.F, 2.F, 4.F}) {
    const RgbdImage seen = apply_sensor(flat(z), kCamera, options, 1, FrameId(3));
    const Spread spread = spread_of(seen.depth.mat);
    EXPECT_NEAR(spread.mean, z, 0.001 * z);
    EXPECT_NEAR(spread.sigma, 0.0015 * z * z, 0.03 * 0.0015 * z * z);
  }
}

TEST(Sensor, QuantisationAddsItsOwnSpread) {
  // One step is z^2 / 40.155 / 8 of depth, uniform within: a sigma of that over sqrt(12). Over a
  // slope, where all phases of a step occur.
  RenderedImage slope = flat(0.F);
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x)
      slope.depth.mat(y, x) = 1.9F + 0.2F * static_cast<float>(y) / 479.F;
  }
  const RgbdImage seen = apply_sensor(slope, kCamera, only_depth_noise(), 1, FrameId(3));
  const cv::Mat1f error = seen.depth.mat - slope.depth.mat;
  const double step = 4.0 / 40.155 / 8.0 / std::sqrt(12.0);
  const double expected = std::hypot(0.0015 * 4.0, step);
  EXPECT_NEAR(spread_of(error).sigma, expected, 0.03 * expected);
}

TEST(Sensor, DisparitiesAreEighthsOfAPixel) {
  const RgbdImage seen = apply_sensor(flat(2.F), kCamera, only_depth_noise(), 1, FrameId(0));
  for (int x = 0; x < 640; ++x) {
    const double eighths = 8.0 * 40.155 / seen.depth.mat(100, x);
    EXPECT_NEAR(eighths, std::round(eighths), 1e-3);
  }
  SensorOptions no_noise = only_depth_noise();
  no_noise.depth_sigma_at_1m_m = 0;
  const RgbdImage quantised = apply_sensor(flat(2.F), kCamera, no_noise, 1, FrameId(0));
  EXPECT_NEAR(quantised.depth.mat(5, 5), 40.155 / 20.125, 1e-5);  // 20.0775 px, rounded
}

TEST(Sensor, NoiseIsTheSameForImagesOfAnotherSize) {
  const CameraModel half = synthetic_camera(320, 240);
  const RenderedImage small{ColorImage(cv::Mat3b(240, 320, cv::Vec3b(9, 9, 9))),
                            DepthImage(cv::Mat1f(240, 320, 2.F)),
                            {}};
  SensorOptions options = only_depth_noise();
  options.disparity_step_px = 0;
  const RgbdImage seen = apply_sensor(small, half, options, 1, FrameId(3));
  EXPECT_NEAR(spread_of(seen.depth.mat).sigma, 0.006, 0.0003);
}

TEST(Sensor, NearThingsShadowTheProjectorOnTheirLeft) {
  RenderedImage step = flat(3.F);
  step.depth.mat(cv::Rect(300, 0, 100, 480)).setTo(1.F);
  const RgbdImage seen = apply_sensor(step, kCamera, only_holes(), 1, FrameId(0));
  // The shadow is 40.155 * (1 - 1/3) = 26.77 pixels wide.
  for (int x = 0; x < 640; ++x) {
    const bool missing = x >= 300 - 26 && x < 300;
    EXPECT_EQ(seen.depth.mat(200, x) == 0.F, missing) << x;
  }
}

TEST(Sensor, EdgesAreRagged) {
  RenderedImage step = flat(3.F);
  step.depth.mat(cv::Rect(300, 0, 100, 480)).setTo(1.F);
  SensorOptions options = only_holes();
  options.edge_dropout = 0.5;
  const RgbdImage seen = apply_sensor(step, kCamera, options, 1, FrameId(0));
  const int missing = 480 - cv::countNonZero(seen.depth.mat.col(400));
  EXPECT_NEAR(missing, 240, 45);  // four sigma of a fair coin
  EXPECT_EQ(cv::countNonZero(seen.depth.mat.col(420)), 480);
}

TEST(Sensor, GrazingSurfacesAreMissing) {
  // A floor h below the axis: z = h fy / (y - cy), turned away by atan(z / h) from the ray.
  RenderedImage floor = flat(0.F);
  for (int y = 260; y < 480; ++y) {
    floor.depth.mat.row(y).setTo(0.4 * kCamera.fx / (y - kCamera.cy));
  }
  SensorOptions options = only_holes();
  options.max_depth_m = 100;
  options.min_depth_m = 0;
  const RgbdImage seen = apply_sensor(floor, kCamera, options, 1, FrameId(0));
  // 80 degrees: z = 0.4 * tan(80 deg) = 2.27 m, at y = 247.6 + 0.4 * 535.4 / 2.27 = 342.
  EXPECT_EQ(seen.depth.mat(330, 320), 0.F);
  EXPECT_GT(seen.depth.mat(350, 320), 0.F);
}

TEST(Sensor, RangeIsLimited) {
  for (const float z : {0.45F, 8.5F}) {
    const RgbdImage seen = apply_sensor(flat(z), kCamera, only_holes(), 1, FrameId(0));
    EXPECT_EQ(cv::countNonZero(seen.depth.mat), 0);
  }
  const RgbdImage seen = apply_sensor(flat(7.5F), kCamera, only_holes(), 1, FrameId(0));
  EXPECT_EQ(cv::countNonZero(seen.depth.mat), 640 * 480);
}

TEST(Sensor, ColourNoiseHasItsSigmaAndChangesFromFrameToFrame) {
  SensorOptions options = SensorOptions::clean();
  options.color_noise = true;
  options.color_sigma = 3.0;
  const cv::Mat3b a = apply_sensor(flat(1.F), kCamera, options, 1, FrameId(0)).color.mat;
  const cv::Mat3b b = apply_sensor(flat(1.F), kCamera, options, 1, FrameId(1)).color.mat;
  const Spread spread = spread_of(cv::Mat1b(a.reshape(1)));
  EXPECT_NEAR(spread.mean, 128, 0.05);
  EXPECT_NEAR(spread.sigma, std::hypot(3.0, 1.0 / std::sqrt(12.0)), 0.05);
  EXPECT_GT(cv::norm(a, b, cv::NORM_INF), 5);
}

TEST(Sensor, ExposureDriftsSlowlyAndScalesBrightness) {
  double lowest = 2, highest = 0, fastest = 0;
  for (std::uint32_t i = 0; i < 600; ++i) {
    const double green = exposure_gains(0.06, 3, FrameId(i))[1];
    const double next = exposure_gains(0.06, 3, FrameId(i + 1))[1];
    lowest = std::min(lowest, green);
    highest = std::max(highest, green);
    fastest = std::max(fastest, std::abs(next - green));
  }
  EXPECT_GT(lowest, 1 - 0.06 * 1.5);
  EXPECT_LT(highest, 1 + 0.06 * 1.5);
  EXPECT_GT(highest - lowest, 0.06);
  EXPECT_LT(fastest, 0.004);
  SensorOptions options = SensorOptions::clean();
  options.exposure_drift = true;
  const cv::Vec3b seen =
      apply_sensor(flat(1.F, {200, 100, 50}), kCamera, options, 3, FrameId(70)).color.mat(9, 9);
  const std::array<float, 3> gains = exposure_gains(options.drift_share, 3, FrameId(70));
  EXPECT_NEAR(seen[0], 200 * gains[0], 0.51);
  EXPECT_NEAR(seen[1], 100 * gains[1], 0.51);
  EXPECT_NEAR(seen[2], 50 * gains[2], 0.51);
}

}  // namespace
}  // namespace stillmap
